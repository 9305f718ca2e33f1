"""LandXML that refers to others or grows, and drawings that refer to others."""

from __future__ import annotations

from pathlib import Path
from string import Template

import pytest

from delone import FileFormatError
from delone.io import read_points, read_surface
from delone.terrain import TIN

CORPUS = Path(__file__).parents[1] / "corpus" / "hostile"
READERS = read_points, read_surface, TIN.from_file


def filled(name, canary, listener):
    text = (CORPUS / name).read_text(encoding="utf-8")
    return Template(text).safe_substitute(file=canary.csv, url=listener.url)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-32"])
@pytest.mark.parametrize("name", ["billion-laughs", "external-entity", "external-subset"])
def test_document_types_are_refused(tmp_path, canary, listener, name, encoding):
    pytest.importorskip("lxml")
    text = filled(f"{name}.landxml", canary, listener).replace("utf-8", encoding)
    (tmp_path / "a.xml").write_text(text, encoding=encoding)
    canary.watch()
    for read in READERS:
        with pytest.raises(
            FileFormatError, match="DOCTYPE|not valid XML" if encoding == "utf-32" else "DOCTYPE"
        ):
            read(tmp_path / "a.xml")
    assert not canary.was_opened
    assert listener.requests == []


def test_inclusions_and_schemas_are_left_alone(tmp_path, canary, listener):
    pytest.importorskip("lxml")
    (tmp_path / "a.landxml").write_text(filled("inclusion.landxml", canary, listener))
    canary.watch()
    for read in READERS:
        with pytest.raises(FileFormatError, match="line 3: 3 numbers for each point"):
            read(tmp_path / "a.landxml")
    assert not canary.was_opened
    assert listener.requests == []


def test_references_of_drawings_are_left_alone(tmp_path, canary, listener):
    ezdxf = pytest.importorskip("ezdxf")
    (canary.folder / "other.dxf").write_text("")
    drawing = ezdxf.new()
    for number, target in enumerate((canary.folder / "other.dxf", f"{listener.url}/a.dxf")):
        drawing.add_xref_def(str(target), f"other{number}")
        drawing.modelspace().add_blockref(f"other{number}", (0, 0))
    image = drawing.add_image_def(str(canary.csv), (10, 10))
    drawing.modelspace().add_image(image, (0, 0), (1, 1))
    drawing.modelspace().add_3dface([(0, 0, 0), (4, 0, 0), (0, 3, 1)])
    drawing.saveas(tmp_path / "a.dxf")
    canary.watch()
    assert len(read_points(tmp_path / "a.dxf")) == 3
    assert TIN.from_file(tmp_path / "a.dxf").nsimplex == 1
    assert not canary.was_opened
    assert listener.requests == []
