"""Triangulation of a file: the command ``delone triangulate``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from delone import ConstrainedDelaunay, Delaunay, __version__
from delone.cli.constraints import Constraints, constraint_figures, read_input, triangulated
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
from delone.cli.notes import note
from delone.cli.options import (
    Chord,
    Classes,
    Columns,
    Flat,
    Input,
    Json,
    Layer,
    MeshOutput,
    Quiet,
    Solid,
    Workers,
    class_numbers,
    require_files,
    space_or_plane,
    split,
)
from delone.cli.outputs import ready, write_all
from delone.cli.referenced import Crs, Planar, referenced, require_known
from delone.cli.report import Stopwatch, summary
from delone.cli.show import print_json, print_report, space_rows, spinner, triangulation_rows
from delone.cli.solid import (
    improved,
    improvement_figures,
    improvement_rows,
    is_space,
    space_summary,
    triangulated_space,
)
from delone.io import GeometrySet, PointSet
from delone.io.writing import WITH_CRS, writer

if TYPE_CHECKING:
    from delone import TetMesh
    from delone.cli.report import Mesh

__all__ = ["triangulate"]


def triangulate(
    source: Input,
    *,
    output: MeshOutput = None,
    chord: Chord = None,
    classes: Classes = None,
    columns: Columns = None,
    layer: Layer = None,
    method: Annotated[
        str, typer.Option(help="Algorithm; the result does not depend on it.")
    ] = "auto",
    workers: Workers = None,
    edges: Annotated[
        bool, typer.Option("--edges", help="Write edges instead of triangles.")
    ] = False,
    crossing: Annotated[
        str | None,
        typer.Option(
            help="Where lines cross: split (add a vertex, the default) or raise (an error)."
        ),
    ] = None,
    outline: Annotated[
        bool,
        typer.Option(
            "--outline", help="Remove triangles outside polygons, or outside closed lines."
        ),
    ] = False,
    conforming: Annotated[
        bool,
        typer.Option("--conforming", help="Add vertices until all segments are Delaunay edges."),
    ] = False,
    max_points: Annotated[
        int | None,
        typer.Option(
            help="Maximum number of vertices added to lines and polygons, or by --improve, for "
            "which the default is 0."
        ),
    ] = None,
    in_space: Solid = False,
    in_plane: Flat = False,
    better: Annotated[
        bool,
        typer.Option("--improve", help="3-D: remove slivers; points inside may move."),
    ] = False,
    min_angle: Annotated[
        float | None,
        typer.Option(
            metavar="DEGREES",
            help="Goal of --improve for dihedral angles, in degrees; 20 by default.",
        ),
    ] = None,
    crs: Crs = None,
    planar: Planar = False,
    max_iter: Annotated[
        int | None,
        typer.Option(
            min=0,
            metavar="N",
            help="Maximum number of passes of --improve over the tetrahedra; 30 by default.",
        ),
    ] = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Triangulate the points of a file, report, and write meshes and plots.

    Lines and the sides of polygons become edges of the triangulation. Heights are values at the
    points; with --3d they are the third coordinate, and tetrahedra are written to .vtu, .msh, .npz,
    .xdmf, .inp, .su2 and .png.
    """
    space = space_or_plane(in_space, in_plane)
    for option, value, what in (("min-angle", min_angle, "goal"), ("max-iter", max_iter, "limit")):
        if value is not None and not better:
            raise Failure(
                f"--{option} is the {what} of --improve: give --improve as well", Exit.USAGE
            )
    require_files(edges, output)
    require_known(crs)
    with writing():
        protect_inputs(output or (), source)
        writers = {path: ready(path) for path in output or ()}
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        say(f"reading {source.name}")
        with reading(quiet=quiet), watch.stage("read"):
            survey = read_input(
                source,
                columns=split(columns),
                classes=class_numbers(classes),
                layer=layer,
                chord=chord,
            )
        survey = referenced(
            survey, crs, planar=planar, quiet=quiet, outputs=writers, known=WITH_CRS
        )
        say(f"triangulating {len(survey):,} {_what(survey)}")
        constraints = Constraints(crossing, outline, conforming, None if better else max_points)
        solid = is_space(source, space, survey)
        if solid and isinstance(survey, PointSet):
            constraints.require_none(survey.source)
            with writing():
                writers = {path: writer(path, space=True) for path in writers}
            mesh: Mesh = triangulated_space(survey, method=method, workers=workers)
            z = None
            if space is None and not better:
                note(
                    f"{source}: three columns: 3-D tetrahedra; --2d triangulates the surface",
                    quiet=quiet,
                )
        else:
            mesh, z = triangulated(survey, constraints, method=method, workers=workers)
        watch.seconds |= mesh.stages
        written: Mesh | TetMesh = mesh
        gained: dict[str, Any] = {}
        if better:
            if not (solid and isinstance(mesh, Delaunay)):
                raise Failure("--improve is for tetrahedra: give --3d", Exit.USAGE)
            with watch.stage("improve"):
                tetrahedra = improved(
                    mesh,
                    writers,
                    say,
                    min_angle=min_angle,
                    passes=max_iter,
                    most_points=max_points,
                )
            written, gained = tetrahedra, {"improvement": improvement_figures(tetrahedra.report)}
        write_all(writers, written, watch, say, z=z, crs=survey.crs, edges=edges)
        say("measuring")
        with watch.stage("measure"):
            measures = (
                space_summary(mesh) if isinstance(mesh, Delaunay) and solid else summary(mesh)
            )
        figures: dict[str, Any] = {
            "delone": __version__,
            "input": str(source),
            "crs": survey.crs,
            **measures,
            **_of_constraints(mesh, survey),
            **gained,
            **watch.ending(writers, mesh.npoints),
        }
    if as_json:
        print_json(figures)
    elif not quiet:
        rows = space_rows(figures) if solid else triangulation_rows(figures)
        rows += improvement_rows(figures["improvement"]) if better else []
        print_report(str(source), rows, figures)


def _what(survey: PointSet | GeometrySet) -> str:
    return "features" if isinstance(survey, GeometrySet) else "points"


def _of_constraints(mesh: Mesh, survey: PointSet | GeometrySet) -> dict[str, Any]:
    if isinstance(mesh, ConstrainedDelaunay) and isinstance(survey, GeometrySet):
        return {"constraints": constraint_figures(mesh, survey)}
    return {}
