"""Each exit code, one line for each error, and no output half written."""

import ast
import errno
import json
import os
import re
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import delone
from delone import InternalError, __version__
from delone.cli.commands import COMMANDS, _loaded, options_of
from delone.cli.exits import MEANINGS, Exit
from delone.cli.wording import ARGUMENTS, Switch, as_options

COMMAND = [sys.executable, "-m", "delone"]


def process(*arguments, **options):
    command = [*COMMAND, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def test_every_code_is_documented(command):
    code, out, _ = command("--help")
    assert code == 0
    assert set(MEANINGS) == set(Exit)
    for number in Exit:
        assert f"{number.value:>3}  " in out
    assert command("--version") == (0, f"delone {__version__}\n", "")


@pytest.mark.parametrize(
    "case",
    [
        (["triangulate"], 2, "INPUT"),
        (["triangulate", "S", "--nonsense"], 2, "nonsense"),
        (["nonsense"], 2, "nonsense"),
        (["triangulate", "S", "--method", "guess"], 2, "bowyer-watson"),
        (["triangulate", "S", "--workers", "0"], 2, "workers"),
        (["triangulate", "S", "--classes", "ground"], 2, "classes"),
        (["triangulate", "missing.csv"], 3, "no such file"),
        (["triangulate", "S", "--columns", "x,w"], 3, "its columns are x, y, z"),
        (["triangulate", "unknown.doc"], 3, "known suffixes are .csv"),
        (["info", "empty.csv"], 3, "is empty"),
        (["info", "torn.laz"], 3, "version or the size"),
        (["check", "torn.npz"], 3, "truncated"),
        (["triangulate", "line.csv"], 4, "line"),
        (["triangulate", "two.csv"], 4, "two|few"),
        (["triangulate", "nan.csv"], 4, "row 1"),
        (["triangulate", "S", "-o", "a.doc"], 5, "known suffixes are .vtu"),
        (["triangulate", "S", "-o", "nowhere/a.vtu"], 5, "does not exist"),
        (["triangulate", "S", "-o", "a.vtu", "-o", "a.stl", "--edges"], 5, "cannot store edges"),
    ],
)
def test_one_line_and_a_code(survey, command, tmp_path, monkeypatch, case):
    arguments, code, words = case
    monkeypatch.chdir(tmp_path)
    for name, text in {
        "unknown.doc": "1,2\n", "empty.csv": "", "torn.laz": "LASF", "torn.npz": "PK",
        "line.csv": "0,0\n1,1\n2,2\n", "two.csv": "0,0\n1,1\n0,0\n", "nan.csv": "0,0\nnan,1\n2,5\n",
    }.items():  # fmt: skip
        (tmp_path / name).write_text(text)
    before = sorted(path.name for path in tmp_path.iterdir())
    found, out, err = command(*[survey if a == "S" else a for a in arguments])
    assert (found, out) == (code, "")
    assert err.startswith("delone: ")
    assert err.count("\n") == 1
    assert any(word in err for word in words.split("|"))
    assert sorted(path.name for path in tmp_path.iterdir()) == before


@pytest.mark.parametrize(
    "case",
    [
        ("triangulate", "a.vtu", "meshio", "mesh"),
        ("triangulate", "a.xdmf", "h5py", "mesh"),
        ("voronoi", "a.parquet", "pyarrow.parquet", "geo"),
        ("voronoi", "a.gpkg", "geopandas", "geo"),
    ],
)
def test_missing_extra(survey, command, tmp_path, monkeypatch, case):
    name, file, library, extra = case
    monkeypatch.setitem(sys.modules, library, None)
    code, _, err = command(name, survey, "-o", tmp_path / file)
    assert code == 6
    assert f'pip install "delone[{extra}]"' in err


def test_help_imports_no_library_that_a_command_may_need():
    code = """
import sys
from delone.cli import run
assert run(["--help"]) == 0
libraries = set(sys.modules) - set(sys.stdlib_module_names)
print(sorted({name.split(".")[0] for name in libraries} - set(sys.stdlib_module_names)))
print(sorted(name for name in sys.modules if name.startswith("rich.")))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    libraries, parts = map(ast.literal_eval, done.stdout.splitlines()[-2:])
    # What typer brings along differs from version to version; what commands need is an extra.
    needed = {"delone", "numpy", "typer"}
    assert needed < set(libraries)
    extras = {"dask", "ezdxf", "geopandas", "laspy", "lxml", "matplotlib", "meshio", "networkx"}
    extras |= {"pandas", "pyarrow", "pyogrio", "pyproj", "pyvista", "rasterio", "scipy", "shapely"}
    assert not extras & set(libraries)
    assert {"rich.console", "rich.progress", "rich.table"}.isdisjoint(parts)


@pytest.mark.parametrize("library", ["typer", "rich"])
def test_without_the_extra_of_the_command(library):
    code = f"import sys; sys.modules['{library}'] = None; from delone.__main__ import main; main()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 6
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert 'pip install "delone[cli]"' in done.stderr


@pytest.mark.parametrize(
    "case",
    [
        (MemoryError(), 7),
        (InternalError("a check failed"), 70),
        (RuntimeError("surprise"), 70),
        (KeyboardInterrupt(), 130),
        (OSError(errno.ENOSPC, "No space left on device", "a.vtu"), 5),
        (OSError(errno.ENOSPC, "No space left on device"), 5),
        (OSError(errno.EIO, "Input/output error"), 5),
        (OSError("3000 requested and 1011 written"), 5),
        (type("WriteError", (Exception,), {"__module__": "meshio._exceptions"})("broken"), 5),
    ],
)
def test_errors_while_writing(survey, command, tmp_path, monkeypatch, case):
    error, code = case

    def write(path, *_, **__):
        path.write_bytes(b"half")
        raise error

    monkeypatch.setattr("delone.io.mesh.write_mesh", write)
    out = tmp_path / "out"
    out.mkdir()
    # The first file is whole when the second one fails: neither may appear.
    found, stdout, err = command("triangulate", survey, "-o", out / "a.npz", "-o", out / "a.vtu")
    assert (found, stdout) == (code, "")
    assert err.startswith("delone: ")
    assert err.count("\n") == 1
    assert code != 5 or "a.vtu" in err
    assert "None" not in err
    assert list(out.iterdir()) == []


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_signals_leave_nothing_behind(survey, tmp_path, number, code):
    out = tmp_path / "out"
    out.mkdir()
    script = (
        "import delone.io.mesh as m, signal, sys, time\n"
        # A shell may have started the tests in the background, where Ctrl-C is ignored.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "def write(path, *a, **k):\n"
        "    path.write_bytes(b'half'); print('writing', flush=True); time.sleep(60)\n"
        "m.write_mesh = write\n"
        "from delone.__main__ import main\n"
        f"sys.argv = ['delone', 'triangulate', {str(survey)!r}, '-o', {str(out / 'a.vtu')!r}]\n"
        "main()\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as child:
        assert child.stdout.readline() == "writing\n"
        child.send_signal(number)
        _, err = child.communicate(timeout=30)
    assert child.returncode == code
    assert list(out.iterdir()) == []
    assert "Traceback" not in err


def test_as_a_process(survey, tmp_path):
    done = process("triangulate", survey, "-o", tmp_path / "a.png")
    assert done.returncode == 0
    assert done.stderr == ""
    assert "written" in done.stdout
    done = process("triangulate", tmp_path / "missing.csv")
    assert done.returncode == 3
    assert done.stderr == f"delone: {tmp_path / 'missing.csv'}: no such file\n"


@pytest.mark.skipif(os.name == "nt", reason="POSIX pipes")
@pytest.mark.parametrize(
    "arguments",
    [
        ["info", "S"],
        ["triangulate", "S", "-o", "a.npz"],
        ["triangulate", "S", "-o", "a.npz", "--json"],
        ["check", "--help"],
        ["--help"],
        ["--version"],
    ],
    ids=" ".join,
)
@pytest.mark.sampled(3)
def test_a_reader_that_goes_away(survey, tmp_path, arguments):
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "w") as gone:
        done = subprocess.run(
            [*COMMAND, *[str(survey) if a == "S" else a for a in arguments]],
            stdout=gone, stderr=subprocess.PIPE, check=False, cwd=tmp_path,
        )  # fmt: skip
    # What a shell says of a program that SIGPIPE has ended.
    assert (done.returncode, done.stderr) == (128 + 13, b"")
    assert (tmp_path / "a.npz").exists() == ("-o" in arguments)


@pytest.mark.skipif(os.name == "nt", reason="POSIX pipes")
def test_nobody_reads_the_error_either(tmp_path):
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "w") as gone:
        done = subprocess.run(
            [*COMMAND, "info", "missing.csv"], stdout=gone, stderr=gone, check=False, cwd=tmp_path
        )
    assert done.returncode == 3


@pytest.mark.parametrize("name", ["triangulate", "voronoi", "mesh", "interpolate"])
def test_no_input_is_replaced(tmp_path: Path, command, name: str) -> None:
    ring = [[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]]
    square = {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon"}}
    square["geometry"]["coordinates"] = [ring]
    source = tmp_path / "a.geojson"
    source.write_text(json.dumps({"type": "FeatureCollection", "features": [square]}))
    before = source.read_bytes()
    link = tmp_path / "link.geojson"
    link.symlink_to(source)
    options = ["--value", "z", "--grid", "2x2"] if name == "interpolate" else []
    code, _, err = command(name, source, *options, "-o", link)
    assert code == 2 and "would replace the input" in err
    code, _, err = command(
        name, source, *options, "-o", tmp_path / "b.gpkg", "-o", tmp_path / "b.gpkg"
    )
    assert code == 2 and "same file" in err
    assert source.read_bytes() == before and not (tmp_path / "b.gpkg").exists()


def test_an_outline_is_not_replaced_either(tmp_path: Path, command) -> None:
    (tmp_path / "sites.csv").write_text("x,y\n0,0\n1,0\n0,1\n")
    outline = tmp_path / "outline.geojson"
    outline.write_text("{}")
    code, _, err = command("voronoi", tmp_path / "sites.csv", "--clip", outline, "-o", outline)
    assert code == 2 and "would replace the input" in err
    assert outline.read_text() == "{}"


def test_nan_rows_are_named(tmp_path, command):
    points = np.random.default_rng(0).random((50, 2))
    points[[3, 17, 40]] = np.nan
    np.save(tmp_path / "a.npy", points)
    code, _, err = command("triangulate", tmp_path / "a.npy")
    assert code == 4
    assert "3, 17, 40" in err


def _shell(line: str, folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    program = f"{sys.executable} -m delone"
    return subprocess.run(
        ["sh", "-c", line.replace("delone", program, 1)],
        cwd=folder, env={**os.environ, **environment}, capture_output=True, text=True, check=False,
    )  # fmt: skip


def test_output_that_cannot_be_printed_is_no_bug(tmp_path: Path) -> None:
    for name in ("ok.csv", "ü.csv"):
        (tmp_path / name).write_text("x,y\n0,0\n1,0\n0,1\n")
    if Path("/dev/full").is_char_device():
        for command in ("triangulate ok.csv -o a.npz", "info ok.csv --json", "--help"):
            done = _shell(f"delone {command} > /dev/full", tmp_path)
            assert (done.returncode, done.stderr.count("\n")) == (5, 1)
            assert "cannot be printed" in done.stderr
        assert (tmp_path / "a.npz").exists()
    done = _shell("delone triangulate ok.csv -o b.npz >&-", tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "b.npz").exists()
    done = _shell("delone triangulate ü.csv -o c.npz", tmp_path, PYTHONIOENCODING="ascii")
    assert (done.returncode, done.stderr) == (0, "")
    assert "?.csv" in done.stdout


def test_attributes_of_exceptions_are_left_to_python(tmp_path, command):
    np.savetxt(tmp_path / "a.xyz", [(0, 0), (1, 1), (2, 2)])
    code, _, err = command("triangulate", tmp_path / "a.xyz")
    assert code == 4
    assert err.strip().endswith("so there is no triangle")
    with pytest.raises(delone.DegenerateInputError, match=r"error\.chain"):
        delone.Delaunay([(0, 0), (1, 1), (2, 2)])
    # The rest of such a message stays.
    said = "bad; `error.rows` has them, in order; choose nan='drop'"
    assert as_options(said, {"nan": Switch("--nan")}) == "bad; choose --nan drop"
    # A command without the option does not advise it.
    assert as_options(said, {"max_edge": Switch("--max-edge")}) == "bad"


TABLE = "x,y,z\n# a survey\n0,0,1\n\n1,{},2\n0,1,3\n0,1,4\n"


@pytest.mark.parametrize(
    "case",
    [
        ("nan", ["triangulate"], "row 1; drop or repair it; line 5 of a.csv"),
        ("inf", ["triangulate", "--3d"], "line 5 of a.csv"),
        ("nan", ["voronoi"], "line 5 of a.csv"),
        ("nan", ["tile", "-o", "a.tin", "--workers", "1"], "(row 1); line 5 of a.csv"),
        ("nan", ["crossval"], "line 5 of a.csv"),
        ("5", ["crossval"], "rows 3 and 2;"),
        ("5", ["crossval"], "lines 7, 6 of a.csv"),
        ("5", ["interpolate", "--grid", "3x3"], "lines 7, 6 of a.csv"),
    ],
)
def test_rows_of_text_have_lines(tmp_path, monkeypatch, command, case):
    number, arguments, words = case
    monkeypatch.chdir(tmp_path)
    Path("a.csv").write_text(TABLE.format(number))
    code, _, err = command(arguments[0], "a.csv", *arguments[1:])
    assert code == 4
    assert words in err and err.count("\n") == 1


def test_heights_that_differ_have_the_lines_of_both(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    Path("a.csv").write_text("x,y,z\n0,0,1\n1,0,1\n0,1,1\n1,0,7\n1,0,3\n1,1,1\n")
    code, _, err = command("contours", "a.csv", "--interval", 1)
    assert code == 4 and "give --tolerance, the largest" in err
    assert err.strip().endswith("; lines 5, 3 of a.csv")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("contours", "--interval", "1", "--workers", "0"), "--workers must be an integer of at"),
        (("triangulate", "--workers", "0"), "--workers must be an integer of at least 1, got 0"),
        (("voronoi", "--workers", "0"), "--workers must be an integer of at least 1, got 0"),
        (("contours", "--interval", "0"), "--interval must be above 0 and finite, got 0.0"),
        (("contours", "--interval", "1", "--base", "inf"), "--base must be finite"),
        (("contours", "--interval", "1", "--max-edge", "0"), "--max-edge must be above 0"),
        (("contours", "--interval", "1", "--smooth", "6"), "--smooth must be an integer from 0"),
        (("contours", "--interval", "1", "--smooth", "-1"), "--smooth must be an integer from 0"),
        (("contours",), "give either --levels or --interval"),
        (("contours", "--levels", "1,nan"), "--levels takes numbers, got '1,nan'"),
        (("contours", "--levels", "inf"), "--levels takes numbers, got 'inf'"),
        (("triangulate", "--method", "x"), "--method must be one of 'auto'"),
    ],
)
def test_errors_name_options(tmp_path, monkeypatch, command, arguments, words):
    monkeypatch.chdir(tmp_path)
    Path("a.csv").write_text("x,y,z\n0,0,1\n1,0,1\n0,1,1\n1,1,4\n")
    code, _, err = command(arguments[0], "a.csv", *arguments[1:])
    assert code == 2 and err.startswith(f"delone: {words}"), err
    assert "line " not in err


def test_a_run_that_exists_is_resumed_by_an_option(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    Path("a.csv").write_text("x,y\n0,0\n1,0\n0,1\n")
    assert command("tile", "a.csv", "-o", "tiles", "--workers", "1")[0] == 0
    code, _, err = command("tile", "a.csv", "-o", "tiles", "--workers", "1", "--no-resume")
    assert code == 2 and err.strip().endswith("remove it, or use --resume")


def test_words_that_are_no_arguments_stay():
    options = {
        "index": Switch("--index"),
        "interval": Switch("--interval"),
        "max_edge": Switch("--max-edge"),
        "voids": Switch("--voids", "no --voids"),
    }
    said = "the index of a.interval is empty; max_edge, interval=2 or voids=False"
    wanted = "the index of a.interval is empty; --max-edge, --interval 2 or no --voids"
    assert as_options(said, options) == wanted
    assert as_options("index: 1 is too few", options) == "--index: 1 is too few"
    assert as_options("interval of two", options) == "interval of two"
    # What the user has written stays.
    said = "a max_edge=2.csv: give max_edge=2"
    wanted = "a max_edge=2.csv: give --max-edge 2"
    assert as_options(said, options, keep=["a max_edge=2.csv"]) == wanted
    # Messages of the command itself may contain names of columns with an underscore.
    assert as_options("its columns are max_edge", options, words=False).endswith(" max_edge")


def _switches():
    """Each long option of each command."""
    for name in COMMANDS:
        for each in _loaded(name).params:
            for option in each.opts:
                if option.startswith("--") and not option.startswith("--no-"):
                    yield pytest.param(name, option, each, id=f"{name} {option}")


@pytest.mark.parametrize(("name", "option", "parameter"), list(_switches()))
def test_every_argument_becomes_its_option(name, option, parameter):
    options, argument = options_of([name]), option[2:].replace("-", "_")
    of = partial(as_options, options=options)
    off = next(iter(parameter.secondary_opts), f"no {option}")
    if parameter.is_flag:
        assert of(f"give {argument}=True, or {argument}=False") == f"give {option}, or {off}"
    elif argument != "bounds" or "window" not in options:
        for value, shown in {
            "2": "2", "-1.5e-7": "-1.5e-7", "-inf": "-inf", "nan": "nan", "'a'": "a",
            "'a' or 'b'": "a or b", '"a", "b" or "c-d"': "a, b or c-d", "(1, -2.5)": "1,-2.5",
        }.items():  # fmt: skip
            assert of(f"so give {argument}={value}.") == f"so give {option} {shown}."
            assert of(f"it is {argument}={value}: so") == f"it is {option} {shown}: so"
    for after in ("must be above 0, got -1.0", "needs another", "is for others"):
        assert of(f"{argument} {after}") == f"{option} {after}"
    assert of(f"{argument}: 2 is bad") == f"{option}: 2 is bad"
    # An ordinary word that has the name of the option stays.
    if "_" not in argument:
        assert of(f"the {argument} of this") == f"the {argument} of this"


def _messages():
    """Each argument with an equals sign in a message of the package, with its file."""
    root = Path(delone.__file__).parent
    for path in sorted(root.rglob("*.py")):
        room = path.relative_to(root).parts[0]
        if room in ("cli", "compat", "explorer") or path.name == "landxml_writing.py":
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            # Texts of several lines are documentation, those in angle brackets representations.
            said = node.value if isinstance(node, ast.Constant) else None
            if isinstance(said, str) and " " in said and not re.search(r"\n|^<|^, \w+=$", said):
                for found in re.finditer(r"(?<![\w.-])([a-z_]\w*)=(?!=)", said):
                    yield found[1], f"{path.name}: {said}"


def test_every_argument_in_messages_is_known():
    known = set(ARGUMENTS).union(*(options_of([name]) for name in COMMANDS))
    messages = list(_messages())
    assert len(messages) > 50
    assert [said for name, said in messages if name not in known] == []


def test_advice_that_a_command_cannot_follow_is_left_out():
    nan = "values: 1 of 9 is NaN; first: 3; choose nan='drop' or nan='propagate'; line 4 of a.csv"
    assert (
        as_options(nan, options_of(["hull"])) == "values: 1 of 9 is NaN; first: 3; line 4 of a.csv"
    )
    few = 'too few points, or if these are three points, pass flat="project"'
    assert as_options(few, options_of(["hull"])) == "too few points"
    rings = 'do rings run the other way? winding="smaller" takes the smaller side'
    assert as_options(rings, options_of(["regrid"])) == "do rings run the other way?"
    # Nothing is left out where no option is known, nor a whole message.
    assert as_options(nan, {}) == nan
    assert as_options("flat='project' is bad", options_of(["hull"])) == "flat='project' is bad"


@pytest.mark.parametrize(
    ("name", "said", "wanted"),
    [
        ("contours", "is: give nodata=-9 (--nodata) or", "is: give --nodata -9 or"),
        ("contours", "no cell is inside bounds=(1.0, 2.0)", "no cell is inside --window 1.0,2.0"),
        ("dem", "no cell is inside bounds=(1.0, 2.0)", "no cell is inside --window 1.0,2.0"),
        ("interpolate", "bounds=(1.0, 2.0)", "--bounds 1.0,2.0"),
        ("interpolate", "choose kind='laplace'", "choose --method laplace"),
        ("contours", "Read it with order='enz' (--easting-first for 'enz')",
         "Read it with --easting-first"),
        ("contours", "faces=False (--retriangulate) is", "--retriangulate is"),
        ("tetrahedralize", "holes: 1 seed", "--hole: 1 seed"),
        ("regrid", "give degrees=True or degrees=False", "give --degrees or --radians"),
        ("tile", "remove it, or use resume=True", "remove it, or use --resume"),
        ("dem", "choose larger cells, or a part with bounds",
         "choose larger cells, or a part with --bounds"),
        ("terrain", "choose larger cells, or a part with bounds", "choose larger cells"),
        ("contours", "it has 3 bands: choose one with band (--layer), from 1",
         "it has 3 bands: choose one with --layer, from 1"),
        ("contours", "several layers; choose one (--layer): a",
         "several layers; choose one (--layer): a"),
        ("ground", "several layers; choose one (--layer): a",
         "several layers; only one can be read: a"),
        ("contours", "at most 9 are read (max_points): leave", "at most 9 are read: leave"),
    ],
)  # fmt: skip
def test_arguments_with_options_of_other_names(name, said, wanted):
    assert as_options(said, options_of([name])) == wanted


def test_rows_of_other_files_have_none(tmp_path, command):
    np.save(tmp_path / "a.npy", [(0, 0), (np.nan, 1), (1, 1)])
    code, _, err = command("triangulate", tmp_path / "a.npy")
    assert code == 4 and "row 1" in err and "line" not in err
