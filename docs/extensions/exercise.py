"""The directives ``.. exercise::`` and ``.. chapter-code::`` of the course.

An exercise asks for a number, a choice, or a change of a figure, and the page says whether the
answer is right (`_static/learn/exercises/main.js`). The content is the answer with its reason; it
opens when it is found or on request. Without scripts that is all. Nothing is stored or sent.

The code of a chapter is a program with all blocks of the page, to download.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import live_steps
from docutils import nodes
from docutils.parsers.rst import directives
from exercise_parts import CLOSING, SOLUTION, Exercise, opening, parsed, script, title_of
from live_files import FOLDER, STATIC
from sphinx.util.docutils import SphinxDirective
from sphinx.util.osutil import relative_uri

if TYPE_CHECKING:
    from collections.abc import Callable

    from sphinx.application import Sphinx

CHAPTERS = Path(__file__).parents[1] / "learn"


class ExerciseNode(nodes.General, nodes.Element):
    """An exercise: a task and a solution."""


class Solution(nodes.General, nodes.Element):
    """The answer to an exercise."""


class ChapterCode(nodes.General, nodes.Element):
    """A link to the code of a page."""


class ExerciseDirective(SphinxDirective):
    """The directive."""

    required_arguments = 1
    final_argument_whitespace = True
    has_content = True
    option_spec: ClassVar[dict[str, Callable[[str], Any]]] = dict.fromkeys(
        ("number", "tolerance", "right", "wrong", "figure", "check"), directives.unchanged_required
    )

    def run(self) -> list[nodes.Node]:
        """Return the exercise."""
        try:
            exercise = parsed(self.options)
        except ValueError as error:
            raise self.error(str(error)) from error
        self._require_check(exercise)
        text, messages = self.state.inline_text(self.arguments[0], self.lineno)
        task = nodes.paragraph("", "", *text, classes=["exercise-task"])
        solution = Solution()
        self.state.nested_parse(self.content, self.content_offset, solution)
        return [ExerciseNode("", task, solution, opening=opening(exercise)), *messages]

    def _require_check(self, exercise: Exercise) -> None:
        """Refuse figures and checks that do not exist."""
        if exercise.kind != "figure":
            return
        if exercise.figure not in live_steps.FIGURES:
            raise self.error(f"there is no figure {exercise.figure}")
        checks = (STATIC / "exercises" / "checks.js").read_text(encoding="utf-8")
        if f"  {exercise.check}(" not in checks:
            raise self.error(f"there is no check {exercise.check} in checks.js")


class ChapterCodeDirective(SphinxDirective):
    """The directive."""

    def run(self) -> list[nodes.Node]:
        """Return the link."""
        return [ChapterCode(name=Path(self.env.docname).name)]


def _visit(translator: Any, node: ExerciseNode) -> None:
    translator.body.append(node["opening"])


def _visit_solution(translator: Any, node: Solution) -> None:
    translator.body.append(SOLUTION)


def _depart(translator: Any, node: nodes.Node) -> None:
    translator.body.append(CLOSING)


def _visit_code(translator: Any, node: ChapterCode) -> None:
    folder = relative_uri(
        translator.builder.get_target_uri(translator.builder.current_docname), FOLDER
    )
    name = node["name"]
    translator.body.append(
        f'<p class="chapter-code"><a href="{folder}/code/{name}.py" download="{name}.py">'
        f"Download the code of this chapter</a> as a program, <code>{name}.py</code>.</p>\n"
    )
    raise nodes.SkipNode


def _nothing(translator: Any, node: nodes.Node) -> None:
    """Write the parts alone, where a page has no scripts."""


def _skip(translator: Any, node: nodes.Node) -> None:
    raise nodes.SkipNode


def add_scripts(
    app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: nodes.document | None
) -> None:
    """Load styles and scripts on the pages that need them."""
    del page, template, context
    if doctree is not None and any(doctree.findall(ExerciseNode)):
        app.add_css_file("learn/learn.css")
        app.add_css_file("learn/exercises/exercises.css")
        app.add_js_file("learn/exercises/main.js", type="module")


def write_code(app: Sphinx, exception: Exception | None) -> None:
    """Write the programs of all chapters to where the pages link."""
    if exception is not None or app.builder.format != "html":
        return
    write_programs(Path(app.outdir) / FOLDER / "code")


def write_programs(folder: Path) -> None:
    """Write a program for each chapter that has code."""
    folder.mkdir(parents=True, exist_ok=True)
    for page in sorted(CHAPTERS.glob("*.rst")):
        text = page.read_text(encoding="utf-8")
        if ".. chapter-code::" in text:
            program = script(text, title_of(text))
            (folder / f"{page.stem}.py").write_text(program, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directives."""
    app.add_directive("exercise", ExerciseDirective)
    app.add_directive("chapter-code", ChapterCodeDirective)
    app.add_node(ExerciseNode, html=(_visit, _nothing), text=(_nothing, _nothing))
    app.add_node(Solution, html=(_visit_solution, _depart), text=(_nothing, _nothing))
    app.add_node(ChapterCode, html=(_visit_code, None), text=(_skip, None))
    app.connect("html-page-context", add_scripts)
    app.connect("build-finished", write_code)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
