"""Holds the player of baked tracks to its limits: python check_uno_size.py AVR_SIZE WITH.elf WITHOUT.elf."""

from __future__ import annotations

import subprocess
import sys
from typing import Tuple

FLASH, RAM = 600, 8  # bytes


def sizes(tool: str, image: str) -> Tuple[int, int]:
    """Flash and RAM of an image, bytes, from the table that avr-size prints."""
    row = subprocess.run([tool, image], capture_output=True, text=True, check=True).stdout.splitlines()[1].split()
    text, data, bss = map(int, row[:3])
    return text + data, data + bss


if __name__ == "__main__":
    (flash, ram), (other_flash, other_ram) = sizes(sys.argv[1], sys.argv[2]), sizes(sys.argv[1], sys.argv[3])
    flash, ram = flash - other_flash, ram - other_ram
    print(f"player: {flash} bytes of flash, {ram} bytes of RAM")
    # Less than these would mean that the compiler has left the player out of the one, or left it in the other.
    sys.exit(0 if 40 <= flash <= FLASH and 4 <= ram <= RAM else 1)
