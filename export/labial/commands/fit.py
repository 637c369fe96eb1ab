"""``labial fit``: a rig that shows on one avatar what the FAPs mean, in millimetres."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Dict


def add_arguments(command: argparse.ArgumentParser) -> None:
    """The avatar and the output file of its rig."""
    command.add_argument("avatar", nargs="+", metavar="AVATAR", help=".glb, .gltf or .vrm, or a table of lip points, "
                         ".csv; several are given one rig that suits them alike")
    command.add_argument("-o", "--output", required=True, metavar="NAME.toml", help="the rig; NAME.png is its picture")
    command.add_argument("--shapes", metavar="KIND", help="arkit, oculus, vrm or other, or names of shapes with commas "
                         "between them; found out from the names without it")
    command.add_argument("--point", action="append", default=[], metavar="NAME=INDEX", help="the vertex of a point "
                         "that is not found by itself, such as chin=1234; may be given several times")
    command.add_argument("--no-figure", action="store_true", help="do not draw NAME.png")


def _points(options: argparse.Namespace) -> Dict[str, int]:
    from labial.errors import LabialError

    found = {}
    for given in options.point:
        name, equals, number = given.partition("=")
        if not equals or not number.isdecimal():
            raise LabialError(f"--point is NAME=INDEX, not {given!r}")
        found[name] = int(number)
    if found and len(options.avatar) > 1:
        raise LabialError("--point goes with one avatar")
    return found


def run(options: argparse.Namespace) -> int:
    """Writes the rig and its picture, and prints its accuracy."""
    from labial.errors import LabialError, needs
    from labial.files.outputs import check_folder, folder

    output = Path(options.output)
    if output.suffix != ".toml":
        raise LabialError(f"{output}: a rig's description is a .toml file")
    with needs("fitting", "fit"):
        import scipy.optimize  # noqa: F401

        from labial.fit.fit import fit
    check_folder(output.parent, output)
    points = _points(options)
    done = fit(options.avatar, points, options.shapes, output.stem)
    names = [output.name]
    with folder(output.parent, output) as made:  # the rig and its picture appear together
        (made / output.name).write_text(done.text, encoding="utf-8")
        if not options.no_figure and done.found is not None:
            from labial.see.picture import draw

            names.append(output.with_suffix(".png").name)
            draw(done.rig, done.found, made / names[-1])
    print("\n".join([*done.report, *(str(output.with_name(name)) for name in names)]))
    return 0
