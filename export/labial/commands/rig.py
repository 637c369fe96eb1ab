"""``labial rig``: a description of servos or blendshapes as a C table."""

from __future__ import annotations

import argparse
from pathlib import Path


def add_arguments(command: argparse.ArgumentParser) -> None:
    """The description, and the output files."""
    command.add_argument("description", metavar="FACE.toml")
    command.add_argument("-o", "--output", required=True, metavar="DIR")
    command.add_argument("--name", help="of the C symbol and the files; the description's file name without it")
    command.add_argument("--calibrate", action="store_true", help="write a sketch for Arduino instead, which finds the "
                         "servos' pulses by commands over the serial line")
    command.add_argument("--json", action="store_true", help="write NAME.json instead, for the npm package")
    command.add_argument("--no-figure", action="store_true", help="do not draw NAME.svg")


def run(options: argparse.Namespace) -> int:
    """Writes NAME.h, NAME.c and, unless --no-figure, NAME.svg; or the file of --calibrate or --json."""
    from labial.files.c import check_name
    from labial.files.outputs import folder
    from labial.rig import calibrate, table, web
    from labial.rig.description import read
    from labial.see import figure

    name = options.name or Path(options.description).stem
    check_name(name, "rig")
    rig = read(options.description, name)
    if options.calibrate:
        print(calibrate.write(rig, options.output))
        return 0
    if options.json:
        print(web.write(rig, options.output))
        return 0
    with folder(options.output) as made:
        paths = table.write(rig, made)
        if not options.no_figure:
            paths.append(made / f"{name}.svg")
            figure.draw(rig, paths[-1])
    for path in paths:
        print(Path(options.output) / path.name)
    return 0
