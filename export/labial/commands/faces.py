"""``labial rig``, ``fit``, ``plot`` and ``page``: faces that move, and motion to look at."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, Dict, Optional, Tuple

from labial import BUNDLED
from labial.commands.common import add_phones, put
from labial.errors import LabialError, needs
from labial.files.c import check_name
from labial.files.outputs import check, check_folder, folder


def add_rig(command: argparse.ArgumentParser) -> None:
    command.add_argument("description", metavar="FACE.toml")
    command.add_argument("-o", "--output", required=True, metavar="DIR")
    command.add_argument("--name", help="of the C symbol and the files; the description's file name without it")
    command.add_argument("--calibrate", action="store_true", help="write a sketch for Arduino instead, which finds the "
                         "servos' pulses by commands over the serial line")
    command.add_argument("--json", action="store_true", help="write NAME.json instead, for the npm package")
    command.add_argument("--no-figure", action="store_true", help="do not draw NAME.svg")


def run_rig(options: argparse.Namespace) -> None:
    from labial.rig import calibrate, table
    from labial.rig.description import read

    name = options.name or Path(options.description).stem
    check_name(name, "rig")
    rig = read(options.description, name)
    if options.calibrate or options.json:
        print((calibrate.write if options.calibrate else table.write_json)(rig, options.output))
        return
    with folder(options.output) as made:
        paths = table.write(rig, made)
        if not options.no_figure:
            with needs("drawing (--no-figure leaves it out)", "rig"):
                from labial.see.plot import draw_rig
            paths.append(made / f"{name}.svg")
            draw_rig(rig, paths[-1])
    for path in paths:
        print(Path(options.output) / path.name)


def add_fit(command: argparse.ArgumentParser) -> None:
    command.add_argument("avatar", nargs="+", metavar="AVATAR", help=".glb, .gltf or .vrm, or a table of lip points, "
                         ".csv; several are given one rig that suits them alike")
    command.add_argument("-o", "--output", required=True, metavar="NAME.toml", help="the rig; NAME.png is its picture")
    command.add_argument("--shapes", metavar="KIND", help="arkit, oculus, vrm or other, or names of shapes with commas "
                         "between them; found out from the names without it")
    _add_points(command)
    command.add_argument("--no-figure", action="store_true", help="do not draw NAME.png")


def _add_points(command: argparse.ArgumentParser, which: str = "") -> None:
    command.add_argument("--point", action="append", default=[], metavar="NAME=INDEX", help=f"{which}the vertex of a "
                         "point that is not found by itself, such as chin=1234; may be given several times")


def _points(options: argparse.Namespace) -> Dict[str, int]:
    found = {}
    for given in options.point:
        name, equals, number = given.partition("=")
        if not equals or not number.isdecimal():
            raise LabialError(f"--point is NAME=INDEX, not {given!r}")
        found[name] = int(number)
    return found


def run_fit(options: argparse.Namespace) -> None:
    output = Path(options.output)
    if output.suffix != ".toml":
        raise LabialError(f"{output}: a rig's description is a .toml file")
    with needs("fitting", "fit"):
        import scipy.optimize  # noqa: F401

        from labial.fit.fit import fit
    check_folder(output.parent, output)
    points = _points(options)
    if points and len(options.avatar) > 1:
        raise LabialError("--point goes with one avatar")
    done = fit(options.avatar, points, options.shapes, output.stem)
    names = [output.name]
    with folder(output.parent, output) as made:  # the rig and its picture appear together
        (made / output.name).write_text(done.text, encoding="utf-8")
        if not options.no_figure and done.found is not None:
            from labial.see.picture import draw

            names.append(output.with_suffix(".png").name)
            draw(done.rig, done.found, made / names[-1])
    print("\n".join([*done.report, *(str(output.with_name(name)) for name in names)]))


def add_plot(command: argparse.ArgumentParser) -> None:
    command.add_argument("frames", metavar="FRAMES", nargs="+",
                         help="frames files (.csv), .fap, or models (.npz, or "
                         f"{' or '.join(BUNDLED)}), which speak the timings; several are overlaid")
    add_phones(command)
    command.add_argument("-o", "--output", required=True, metavar="OUT.png", help=".png, .svg or .pdf")
    command.add_argument("--channels", metavar="A,B,...", help="fap3, open_jaw, ..., opening, stretch or all; one "
                         "panel each (fap3,opening,stretch,fap17)")


def run_plot(options: argparse.Namespace) -> None:
    with needs("plotting", "plot"):
        from labial.see.plot import DEFAULT, plot
    from labial.see.motion import closures, read_bands, read_motions

    check(options.output)
    timings = _timings(options)
    motions, bands = read_motions(options.frames, *timings), read_bands(*timings)
    plot(motions, bands, options.output, options.channels or DEFAULT)
    for motion in motions:
        if least := closures(motion, bands):
            print(f"{motion.name}: least opening in each p, b, m: "
                  + " ".join(f"{label} {opening:.0f}" for label, opening in least))


def _timings(options: argparse.Namespace) -> Tuple[Any, str, Optional[str], Optional[str]]:
    """What :func:`labial.see.motion.read_motion` and `read_bands` take; both read the file."""
    from labial.corpus.formats import stored

    return options.phones and stored(options.phones), options.labels, options.source, options.tier


def add_page(command: argparse.ArgumentParser) -> None:
    command.add_argument("frames", metavar="FRAMES", help="a frames file (.csv), .fap, or a model (.npz, or "
                         f"{' or '.join(BUNDLED)}), which speaks the timings")
    add_phones(command)
    command.add_argument("--audio", metavar="FILE", help="sound in step: WAV, MP3, Ogg, FLAC, AAC, M4A or WebM")
    command.add_argument("--head", metavar="AVATAR.glb", help="show this avatar instead of a drawn mouth")
    command.add_argument("--rig", metavar="FACE.toml", help="with --head: what moves it, such as labial fit writes")
    _add_points(command, "with --head: ")
    command.add_argument("--three", metavar="DIR", help="with --head: the npm package three; node_modules/three "
                         "without it")
    command.add_argument("--title", help="the file's name without it")
    command.add_argument("-o", "--output", required=True, metavar="OUT.html")


def run_page(options: argparse.Namespace) -> None:
    from labial.see.motion import read_bands, read_motion
    from labial.see.page import head_page, page

    check(options.output, ".html", ".htm")
    timings = _timings(options)
    bands, motion = read_bands(*timings), read_motion(options.frames, *timings)
    if options.head is None:
        if options.rig is not None or options.three is not None or options.point:
            raise LabialError("--rig, --point and --three go with --head")
        text = page(motion, bands, options.audio, options.title)
    else:
        text = head_page(motion, options.head, options.rig, options.audio, options.title, options.three,
                         _points(options))
    put(text, options.output)
