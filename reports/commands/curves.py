"""The command `fit` with its options; what it needs is imported when it is called."""

from pathlib import Path
from typing import Annotated, Any

import typer

SceneFile = Annotated[
    Path,
    typer.Argument(
        help="Scene in TOML, as printed by contact-verify solve --example. Layer, tip and effects are used. The "
        "modulus that is fitted and the depths of the loading are not, though a scene must name them."
    ),
]
Written = Annotated[
    list[Path] | None, typer.Option("--write", "-w", help="Also write FILE.csv, .svg, .png or .pdf. Repeatable.")
]


def fit(
    curve: Annotated[
        Path,
        typer.Argument(
            help="Table with columns of depth (or height) and force (or deflection), and time for scenes that relax; "
            "or a microscope's file (.jpk-force, .h5, .tab, .ibw, .csv of AFM Workshop)."
        ),
    ],
    scene: SceneFile,
    *,
    moduli: Annotated[
        str,
        typer.Option(
            "--fit",
            help="Moduli to fit: youngs_modulus; of stacks layer[0].youngs_modulus, base.youngs_modulus; of scenes "
            "that relax moduli,times (or moduli, which keeps the times).",
        ),
    ] = "",
    also: Annotated[
        str,
        typer.Option(
            "--with", help="What else is fitted: contact_point,baseline,tilt (all), thickness, work_of_adhesion."
        ),
    ] = "all",
    units: Annotated[
        str, typer.Option(help='Units of columns whose heads have none, in the order of the columns: "nm,nN".')
    ] = "",
    spring_constant: Annotated[
        str, typer.Option(help='Spring constant of the cantilever, "0.05 N/m", for columns of height and deflection.')
    ] = "",
    sensitivity: Annotated[str, typer.Option(help='Sensitivity of the deflection, "50 nm/V".')] = "",
    until: Annotated[
        str, typer.Option(help="Fit the curve up to this depth, force or share of the largest force: 300nm, 2nN, 60%.")
    ] = "",
    curves: Annotated[
        bool,
        typer.Option(
            "--map",
            help="Fit all curves: a force curve in each column after the depths, or curves numbered by a column.",
        ),
    ] = False,
    uncertain: Annotated[
        str,
        typer.Option(
            help='Uncertain inputs, "radius=5%, thickness=4e-6..6e-6". Their effect is added to the intervals.'
        ),
    ] = "",
    number: Annotated[int, typer.Option("--curve", help="Which curve of a microscope's file, from 0.")] = 0,
    confidence: Annotated[float, typer.Option(help="Confidence of intervals and bands.")] = 0.95,
    write: Written = None,
) -> None:
    """Find Young's modulus from a force curve or from all curves of a map, or relaxation moduli over time.

    Every number has an interval. Prints what Hertz, Dimitriadis and other formulas would have found on the same curve.
    """
    from reports.commands.bench import fit_file  # noqa: PLC0415 - where it is called

    if uncertain and (curves or until):
        raise typer.BadParameter("--uncertain is for whole single curves; leave --map and --until out")
    asked: Any = {"fit": moduli, "also": also, "until": until, "uncertain": uncertain, "confidence": confidence}
    asked |= {"units": units, "spring_constant": spring_constant, "sensitivity": sensitivity}
    fit_file(curve, scene, number=None if curves else number, outputs=write or [], **asked)
