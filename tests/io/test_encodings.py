"""XML in UTF-32 and encodings of East Asia, which expat does not read, and in unknown ones."""

from __future__ import annotations

import pytest

from delone import FileFormatError
from delone.io import read_mesh, read_surface

SURFACE = (
    '<?xml version="1.0" encoding="{}"?><LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2">'
    '<Surfaces><Surface name="{}"><Definition surfType="TIN"><Pnts><P id="1">0 0 1</P>'
    '<P id="2">4 0 2</P><P id="3">0 4 3</P></Pnts><Faces><F>1 2 3</F></Faces></Definition>'
    "</Surface></Surfaces></LandXML>"
)
MESH = (
    '<?xml version="1.0" encoding="{}"?><VTKFile type="UnstructuredGrid"><UnstructuredGrid>'
    '<Piece NumberOfPoints="3" NumberOfCells="1"><Points><DataArray type="Float64" Name="{}" '
    'NumberOfComponents="3">0 0 0 1 0 0 0 1 0</DataArray></Points><Cells>'
    '<DataArray type="Int32" Name="connectivity">0 1 2</DataArray>'
    '<DataArray type="Int32" Name="offsets">3</DataArray>'
    '<DataArray type="UInt8" Name="types">5</DataArray></Cells></Piece></UnstructuredGrid>'
    "</VTKFile>"
)
NAMES = {
    "GB2312": "地面",
    "GBK": "地面",
    "GB18030": "地面",
    "Shift_JIS": "地面ソ",
    "EUC-JP": "地面",
    "ISO-2022-JP": "地面",
    "EUC-KR": "지면",
    "Big5": "地面功",
    "UTF-8": "地面",
    "UTF-16": "地面",
    "UTF-32": "地面",
    "UTF-32LE": "地面",
    "UTF-32BE": "地面",
    "windows-1251": "Земля",
    "ISO-8859-15": "5 €",
}


@pytest.mark.parametrize("encoding", NAMES)
def test_surfaces_in_every_encoding(tmp_path, encoding):
    path = tmp_path / "a.xml"
    name = NAMES[encoding]
    path.write_bytes(SURFACE.format(encoding, name).encode(encoding))
    assert read_surface(path).name == name
    assert read_surface(path, layer=name).points.tolist() == [[0, 0, 1], [0, 4, 2], [4, 0, 3]]
    path = tmp_path / "a.vtu"
    path.write_bytes(MESH.format(encoding, name).encode(encoding))
    assert read_mesh(path).simplices.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize("encoding", ["GBK", "Shift_JIS", "EUC-KR", "UTF-32"])
def test_files_of_many_blocks_are_read_to_their_end(tmp_path, encoding):
    points = "".join(f'<P id="{k}">{k} {k * k} 5</P>' for k in range(9, 6000))
    text = SURFACE.format(encoding, NAMES[encoding]).replace("</Pnts>", f"{points}</Pnts>")
    path = tmp_path / "a.xml"
    path.write_bytes(text.encode(encoding))
    assert path.stat().st_size > 1 << 17
    found = read_surface(path)
    assert found.name == NAMES[encoding]
    assert len(found.points) == 5994


def test_characters_that_windows_adds(tmp_path):
    # Files that declare GB2312 have characters of GBK, those that declare Shift_JIS of cp932.
    path = tmp_path / "a.xml"
    for declared, real, name in (("GB2312", "gbk", "鎔"), ("Shift_JIS", "cp932", "①髙")):
        path.write_bytes(SURFACE.format(declared, name).encode(real))
        assert read_surface(path).name == name


@pytest.mark.parametrize("text", [SURFACE, MESH])
@pytest.mark.parametrize("encoding", ["nonsense", "UTF-7", "utf-8", "GBK", "rot13", "idna", "hex"])
def test_other_declarations_are_errors_of_the_file(tmp_path, text, encoding):
    path = tmp_path / ("a.xml" if text is SURFACE else "a.vtu")
    path.write_bytes(text.format(encoding, "\xff").encode("latin-1"))
    with pytest.raises(FileFormatError, match=r"a\.(xml|vtu)"):
        (read_surface if text is SURFACE else read_mesh)(path)


def test_utf_32_that_is_cut_short(tmp_path):
    path = tmp_path / "a.xml"
    whole = SURFACE.format("UTF-32", "a").encode("UTF-32")
    for size in (4, 6, 41, len(whole) - 2):
        path.write_bytes(whole[:size])
        with pytest.raises(FileFormatError, match=r"a\.xml"):
            read_surface(path)


@pytest.mark.parametrize("encoding", ["Shift_JIS", "UTF-32"])
@pytest.mark.parametrize("text", [SURFACE, MESH])
def test_a_document_type_in_another_encoding(tmp_path, text, encoding):
    path = tmp_path / ("a.xml" if text is SURFACE else "a.vtu")
    whole = text.format(encoding, "ソ").replace("?>", '?><!DOCTYPE a [<!ENTITY b "ソ">]>', 1)
    path.write_bytes(whole.encode(encoding))
    with pytest.raises(FileFormatError, match="DOCTYPE"):
        (read_surface if text is SURFACE else read_mesh)(path)
