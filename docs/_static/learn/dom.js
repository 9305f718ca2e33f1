// Elements of the page.

/** Add an element to another and return it. */
export function append(parent, tag, name, text = "") {
  const element = document.createElement(tag);
  element.className = name;
  element.textContent = text;
  parent.append(element);
  return element;
}
