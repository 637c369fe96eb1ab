"""Runs the micro:bit's firmware and judges the face that it makes.

    python check_microbit.py SCRIPT.c FACE.toml COMMAND...

COMMAND runs the image that traces; SCRIPT.c holds the phonemes that it says, FACE.toml the limits of its servos. Needs
nothing but Python itself, so that it runs wherever the board's emulator does.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Dict, List, Tuple

PERIOD = 20000  # microseconds

#: Microseconds that a pulse on the pin may differ. The emulator looks for due interrupts between blocks of
#: instructions, not always at the same ones: pulses are mostly within 2 microseconds, in one run of ten up to 5 off.
TOLERANCE = 15
NAMES = ("jaw", "upper_lip", "corners")


def script(path: str) -> List[Tuple[str, str, int, int]]:
    """Model, label, first frame and end of each phoneme, 50 frames per second."""
    phonemes, begin = [], 0
    for model, label, length in re.findall(r"\b([SL])\((\w+), (\d+)\)", Path(path).read_text(encoding="ascii")):
        end = begin + int(length)
        phonemes.append((model, label, (begin + 10) // 20, (end + 10) // 20))
        begin = end
    return phonemes


def limits(path: str) -> Dict[str, Dict[str, int]]:
    """The numbers of each output, by a reader that knows no more TOML than this description uses."""
    outputs: Dict[str, Dict[str, int]] = {}
    tables = re.split(r"^\[output\.(\w+)\]$", Path(path).read_text(encoding="utf-8"), flags=re.MULTILINE)
    for name, table in zip(tables[1::2], tables[2::2]):
        outputs[name] = output = {key: int(value) for key, value in re.findall(r"^(\w+) = (\d+)", table, re.MULTILINE)}
        if "closed" in output:
            output.setdefault("neutral", output["closed"])
        output.setdefault("minimum", min(output["neutral"], output["full"]))
        output.setdefault("maximum", max(output["neutral"], output["full"]))
    return outputs


def main(script_path: str, face_path: str, command: List[str]) -> List[str]:
    faults: List[str] = []

    def expect(holds: bool, what: str) -> None:
        if not holds:
            faults.append(what)

    phonemes, servos = script(script_path), limits(face_path)
    expect(len(phonemes) > 50 and tuple(servos) == NAMES, "the script or the description could not be read")
    done = subprocess.run(command, capture_output=True, text=True, timeout=100)
    lines = done.stdout.splitlines()
    faces = [[int(word) for word in re.findall(r"\d+", line)] for line in lines if line.startswith("face ")]
    counts = dict(zip(*[iter(lines[-1].split()[1:])] * 2)) if lines and lines[-1].startswith("end ") else {}
    print(lines[-1] if lines else "no output", done.stderr, sep="\n")
    expect(done.returncode == 0 and bool(counts), f"the firmware did not end well, status {done.returncode}")
    if faults:
        return faults
    number = {name: int(value) for name, value in counts.items()}

    total = len(faces) // 2
    spoken = phonemes[-1][3]
    expect(len(faces) == number["faces"] == 2 * total and spoken < total < spoken + 40,
           f"{len(faces)} faces for twice {spoken} frames and the way to rest")
    expect([face[0] for face in faces] == list(range(len(faces))), "faces are missing or out of order")
    expect(len(lines) == len(faces) + 1, "there are other lines")
    if faults:
        return faults
    # The second time is the first once the servos have come from where they stood.
    expect([face[1:4] for face in faces[20:total]] == [face[1:4] for face in faces[total + 20:]], "the motion changes")
    for column, (name, servo) in enumerate(servos.items(), start=1):
        pulses = [face[column] for face in faces]
        expect(servo["minimum"] <= min(pulses) and max(pulses) <= servo["maximum"], f"{name} leaves its limits")
        expect(max(pulses) - min(pulses) > 0.6 * (servo["maximum"] - servo["minimum"]), f"{name} hardly moves")
        steps = [abs(b - a) for a, b in zip(pulses, pulses[1:])]
        expect(max(steps) <= servo["slew"], f"{name} is faster than its slew limit")
        expect(pulses[total - 1] == pulses[-1] == servo.get("closed", servo["neutral"]), f"{name} does not end at rest")
        # The pins themselves: the handler read its timer where it saw them go high and low.
        expect(all(abs(face[column + 3] - face[column]) <= TOLERANCE for face in faces), f"{name}'s pulses differ")

    def opening(frame: int) -> float:
        """Between the lips as the two servos put them, FAP units: the description's reaches are 560 and 90."""
        lips = servos["jaw"], servos["upper_lip"]
        return sum((faces[frame][1 + i] - lip["neutral"]) / (lip["full"] - lip["neutral"]) * reach
                   for i, (lip, reach) in enumerate(zip(lips, (560, 90))))

    closures = [(begin, end) for model, label, begin, end in phonemes if model == "S" and label in "PBM"]
    expect(len(closures) == 6, "the script's p, b, m were not found")
    for begin, end in closures:
        least = min(opening(frame) for frame in range(begin, end))
        expect(least < 110, f"the lips stay {least:.0f} FAP units open in the closure at frame {begin}")
    widest = max(opening(frame) for frame in range(spoken))
    expect(widest > 450, f"the mouth opens by {widest:.0f} FAP units only")
    laugh = min(begin for model, _, begin, _ in phonemes if model == "L")
    neutral = servos["corners"]["neutral"]
    rest = phonemes[-1][2]  # the silence that ends the laugh, in which the smile begins to fade
    expect(all(face[3] > neutral + 100 for face in faces[laugh + 15:rest]), "the laugh does not smile")
    expect(sum(face[3] for face in faces[:laugh - 15]) / (laugh - 15) < neutral + 60, "speech smiles")

    # A period for each face and more, since the queue is filled before each of the two motions begins. Seven interrupts
    # per period, those of the last period perhaps still to come; nobody else counts periods.
    expect(number["periods"] >= 2 * (total + 1), "faces were shown before their periods began")
    expect(7 * (number["periods"] - 1) <= number["interrupts"] <= 7 * (number["periods"] + 1),
           f"{number['interrupts']} interrupts in {number['periods']} periods, not seven per period")
    expect(0 < number["work"] < number["periods"] * PERIOD, "computing took no time, or more than there was")
    expect(number["late"] == 0, f"{number['late']} faces came late")
    expect(number["stack"] >= 2048, f"{number['stack']} bytes of the stack were left, less than 2,048")
    return faults


if __name__ == "__main__":
    found = main(sys.argv[1], sys.argv[2], sys.argv[3:])
    for fault in found:
        print(f"FAILED: {fault}")
    sys.exit(1 if found else 0)
