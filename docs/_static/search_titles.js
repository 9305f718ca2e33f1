// Results of the search that lead to a section are named after it: a question of "How do I ...?" by
// the question. Sphinx names all of them after their page.

/** The title of each section, by page and anchor, from the index of the search. */
function sectionTitles(index) {
  const found = new Map();
  for (const [title, places] of Object.entries(index.alltitles)) {
    for (const [page, anchor] of places) {
      if (anchor) found.set(`${index.docnames[page]}#${anchor}`, title);
    }
  }
  return found;
}

/** Rename a link to a section, once. */
function rename(link, titles) {
  const [path, anchor] = link.href.split("#");
  const page = [...titles.keys()].find(
    (key) => key.endsWith(`#${anchor}`) && path.split("?")[0].endsWith(`/${key.split("#")[0]}.html`),
  );
  if (!anchor || !page || link.dataset.page) return;
  link.dataset.page = link.textContent;
  link.textContent = titles.get(page);
}

document.addEventListener("DOMContentLoaded", () => {
  const results = document.getElementById("search-results");
  if (!results) return;
  new MutationObserver(() => {
    if (!Search._index) return;
    const titles = sectionTitles(Search._index);
    for (const link of results.querySelectorAll("li > a, .search-result a")) rename(link, titles);
  }).observe(results, { childList: true, subtree: true });
});
