"""Runs the jaw on a simulated Arduino Uno and judges what its pins do; or holds the player of baked tracks to its
limits of size.

    python check_uno.py TALK SIMULATOR IMAGE
    python check_uno.py size AVR_SIZE WITH.elf WITHOUT.elf

TALK is the folder with talk.h, the motion that was baked, talk.lab, the phonemes that it is of, and dfplayer.h with the
times of the sound's module. They are read here as text, the motion's bytes and limits by themselves. Needs nothing but
Python.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import List, Tuple

CLOCK = 16_000_000
PERIOD = 320_000  # clocks: 20 ms
COUNT = 8  # clocks of the timer's count, half a microsecond
PRESS = 8000  # milliseconds at which the button is pressed

#: Most bytes of the player.
FLASH, RAM = 600, 8

#: The command to play file 1 of folder 1, with its checksum, which is worked out once more below.
COMMAND = [0x7E, 0xFF, 0x06, 0x0F, 0x00, 0x01, 0x01, 0xFE, 0xEA, 0xEF]


def constant(text: str, name: str) -> int:
    return int(re.search(rf"#define {name} (\d+)", text)[1])


def track(text: str) -> List[int]:
    """The pulses that talk.h stands for, in counts of half a microsecond, by exact fractions."""
    low, high = constant(text, "TALK_JAW_AT_0"), constant(text, "TALK_JAW_AT_255")
    table = re.search(r"talk_bytes\[(\d+)\][^{]*\{([^}]*)\}", text)
    data = [int(number) for number in re.findall(r"\d+", table[2])]
    if len(data) != int(table[1]) or len(data) != constant(text, "TALK_FRAMES"):
        raise ValueError("talk.h does not hold as many bytes as it says")
    return [2 * (low + (2 * (high - low) * byte + 255) // 510) for byte in data]


def measured(output: str) -> Tuple[List[Tuple[int, int]], List[Tuple[int, int]]]:
    """Begin and length of each pulse, and time and value of each byte on the serial line, in clocks."""
    found = re.findall(r"^(pin|serial) (\d+) (\d+)$", output, re.MULTILINE)
    rows = [(kind, int(clock), int(value)) for kind, clock, value in found]
    edges = [(clock, level) for kind, clock, level in rows if kind == "pin"]
    pulses = [(begin, end - begin) for (begin, level), (end, after) in zip(edges, edges[1:]) if level and not after]
    return pulses, [(clock, byte) for kind, clock, byte in rows if kind == "serial"]


def judge_sound(sent: List[Tuple[int, int]], ready: int) -> List[str]:
    """What is wrong with the commands to the sound's module."""
    faults = []
    commands = [[byte for _, byte in sent[i : i + 10]] for i in range(0, len(sent), 10)]
    if commands != [COMMAND] * 2:
        faults.append(f"the serial line says {commands}, not twice {COMMAND}")
    for command in commands:
        if sum(command[1:7]) + 256 * command[7] + command[8] != 65536:
            faults.append(f"the checksum of {command} is wrong")
    if sent and sent[0][0] < ready * CLOCK // 1000:
        faults.append(f"the first command comes after {sent[0][0] * 1000 // CLOCK} ms, the module needs {ready}")
    return faults


def judge_pulses(pulses: List[Tuple[int, int]], starts: List[int], wanted: List[int], delay: int) -> List[str]:
    """What is wrong with the pulses, of which each must be that of its frame."""
    faults = []
    if any(abs(b - a - PERIOD) > 2 for (a, _), (b, _) in zip(pulses, pulses[1:])):
        faults.append("the pulses are not 20 ms apart")
    expected = {}
    for start in starts:
        # Ten bytes of ten bits, and the module's delay; then the next period.
        sound = start + (100 * CLOCK) // 9600 + delay * CLOCK // 1000
        first = next((number for number, (begin, _) in enumerate(pulses) if begin >= sound), len(pulses))
        expected.update({first + frame: pulse for frame, pulse in enumerate(wanted)})
    shown = wanted[0]
    for number, (_, length) in enumerate(pulses):
        shown = expected.get(number, shown)  # between and behind the motions the jaw stays where it is
        if abs(length - shown * COUNT) > 2:
            faults.append(f"pulse {number} lasts {length / 16:.1f} microseconds, not {shown / 2:.1f}")
    if len(pulses) < max(expected, default=0) + 20:
        faults.append(f"{len(pulses)} pulses are too few for the motion")
    return faults[:8]


def judge_lips(wanted: List[int], lab: str) -> List[str]:
    """Whether the jaw closes in each p, b, m of the phonemes, opens in the vowels, and moves with the speech."""
    faults, closures, lowest, highest = [], 0, min(wanted), max(wanted)
    for line in lab.splitlines():
        begin, end, label = line.split()
        inside = wanted[round(float(begin) * 50) : round(float(end) * 50)]
        share = [(pulse - 2 * 1400) / (2 * 500) for pulse in inside]
        if label in ("P", "B", "M"):
            closures += 1
            if min(share) > 0.15:
                faults.append(f"the jaw stays open by {min(share):.2f} in the {label} at {begin} s")
        if label in ("AY", "AA", "OW", "EY") and max(share) < 0.35:
            faults.append(f"the jaw opens by {max(share):.2f} only in the {label} at {begin} s")
    if closures < 5 or highest - lowest < 0.6 * 2 * 500:
        faults.append("there are too few closures, or too little motion, to judge")
    return faults


def main(folder: Path, command: List[str]) -> List[str]:
    text, times = ((folder / name).read_text(encoding="ascii") for name in ("talk.h", "dfplayer.h"))
    wanted, ready, delay = track(text), constant(times, "DFPLAYER_READY_MS"), constant(times, "DFPLAYER_DELAY_MS")
    end = PRESS + 2 * delay + 20 * len(wanted) + 500
    done = subprocess.run([*command, str(end), str(PRESS)], capture_output=True, text=True, timeout=280, check=False)
    pulses, sent = measured(done.stdout)
    print(f"{len(pulses)} pulses, {len(sent)} bytes, {len(wanted)} frames", done.stderr, sep="\n")
    if done.returncode or not pulses or not sent:
        return [f"the simulation did not end well, status {done.returncode}"]
    starts = [clock for clock, _ in sent[::10]]
    faults = judge_sound(sent, ready) + judge_pulses(pulses, starts, wanted, delay)
    if len(starts) == 2 and not 0 <= starts[1] - PRESS * CLOCK // 1000 <= 3 * PERIOD:
        faults.append("the motion does not begin anew when the button is pressed")
    return faults + judge_lips(wanted, (folder / "talk.lab").read_text(encoding="ascii"))


def sizes(tool: str, image: str) -> Tuple[int, int]:
    """Flash and RAM of an image, bytes, from the table that avr-size prints."""
    row = subprocess.run([tool, image], capture_output=True, text=True, check=True).stdout.splitlines()[1].split()
    text, data, bss = map(int, row[:3])
    return text + data, data + bss


def judge_size(tool: str, image: str, without: str) -> List[str]:
    """What is wrong with the size of the player, by which two images differ."""
    (flash, ram), (other_flash, other_ram) = sizes(tool, image), sizes(tool, without)
    flash, ram = flash - other_flash, ram - other_ram
    told = f"player: {flash} bytes of flash, {ram} bytes of RAM"
    print(told)
    # Less than these would mean that the compiler has left the player out of the one, or left it in the other.
    return [] if 40 <= flash <= FLASH and 4 <= ram <= RAM else [told]


if __name__ == "__main__":
    found = judge_size(*sys.argv[2:]) if sys.argv[1] == "size" else main(Path(sys.argv[1]), sys.argv[2:])
    for fault in found:
        print(f"FAILED: {fault}")
    sys.exit(1 if found else 0)
