"""The parts of exercises and of the code of a chapter, without Sphinx: attributes, HTML, script."""

from __future__ import annotations

import ast
import doctest
import json
import re
from html import escape
from typing import NamedTuple

# Between an answer that is wrong and what the page says about it.
BECAUSE = " -- "


class Exercise(NamedTuple):
    """What is asked for, and what the page says about answers."""

    kind: str  # "number", "choice" or "figure"
    # The number, within a tolerance.
    answer: float = 0.0
    tolerance: float = 0.0
    # Answers to choose from, and what is said about each; "" about the right one.
    choices: tuple[tuple[str, str], ...] = ()
    # Numbers that are typical mistakes, and what is said about them; "" for all others.
    hints: tuple[tuple[str, str], ...] = ()
    # The figure that is to be changed, and the name of the check in `checks.js`.
    figure: str = ""
    check: str = ""


def parsed(options: dict[str, str]) -> Exercise:
    """Return the exercise of the options of the directive; ValueError if they do not fit."""
    kinds = [kind for kind in ("number", "right", "figure") if kind in options]
    if len(kinds) != 1:
        raise ValueError("an exercise has one of :number:, :right: and :figure:")
    wrong = [_with_reason(line) for line in options.get("wrong", "").splitlines() if line.strip()]
    if kinds == ["number"]:
        tolerance = float(options.get("tolerance", "0"))
        hints = tuple((str(_number(key)) if key else "", text) for key, text in wrong)
        return Exercise("number", _number(options["number"]), tolerance, hints=hints)
    if kinds == ["figure"]:
        if "check" not in options:
            raise ValueError("an exercise with a figure has a :check:")
        return Exercise("figure", figure=options["figure"], check=options["check"])
    if not wrong:
        raise ValueError("an exercise with a choice has a :wrong: answer")
    # In an order that does not give the answer away.
    choices = sorted([(options["right"].strip(), ""), *wrong])
    return Exercise("choice", choices=tuple(choices))


def _with_reason(line: str) -> tuple[str, str]:
    answer, because, reason = line.strip().partition(BECAUSE)
    if not because or not reason:
        raise ValueError(f"a wrong answer says why after {BECAUSE.strip()}: {line.strip()}")
    return answer.strip().removeprefix("else"), reason.strip()


def _number(text: str) -> float:
    return float(text.replace(",", ""))


def opening(exercise: Exercise) -> str:
    """Return the start of the element, with all that `exercises/main.js` needs."""
    values = {"exercise": exercise.kind}
    if exercise.kind == "number":
        values |= {"answer": repr(exercise.answer), "tolerance": repr(exercise.tolerance)}
        values["hints"] = json.dumps(dict(exercise.hints))
    elif exercise.kind == "choice":
        values["choices"] = json.dumps(exercise.choices)
    else:
        values |= {"figure": exercise.figure, "check": exercise.check}
    attributes = "".join(f' data-{key}="{escape(value)}"' for key, value in values.items())
    return f'<div class="exercise"{attributes}>\n'


# Without scripts the answer can be opened; with them it opens by itself when it is found.
SOLUTION = '<details class="exercise-solution"><summary>Show the answer</summary>\n'
CLOSING = "</details></div>\n"


def script(text: str, title: str) -> str:
    """Return the code of a page in reStructuredText as a program, with results as comments."""
    lines = [f'"""{title}: the code of this chapter of the course."""', ""]
    for example in doctest.DocTestParser().get_examples(text):
        source, want = example.source.rstrip("\n"), example.want.rstrip("\n")
        if example.exc_msg is not None:
            inside = source.replace("\n", "\n    ")
            lines += [f"try:\n    {inside}", "except Exception as error:\n    print(error)", ""]
            continue
        body = ast.parse(source).body
        if want and len(body) == 1 and isinstance(body[0], ast.Expr) and not _prints(body[0]):
            # A tuple is one value, as it is shown on the page.
            value = f"({source})" if isinstance(body[0].value, ast.Tuple) else source
            source = f"print({value})"
        lines += [source]
        if want:
            lines += [*(f"# {line}" for line in want.splitlines()), ""]
    return "\n".join(lines).rstrip("\n") + "\n"


def _prints(statement: ast.Expr) -> bool:
    call = statement.value
    return (
        isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "print"
    )


def title_of(text: str) -> str:
    """Return the title of a page, without the number of the chapter."""
    match = re.search(r"^(?:\d+\. )?(.+)\n=+$", text, re.MULTILINE)
    return match[1] if match else "delone"
