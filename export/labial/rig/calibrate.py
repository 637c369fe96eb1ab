"""A sketch for Arduino that finds the pulses of a face: ``labial rig --calibrate``."""

from __future__ import annotations

from pathlib import Path

from labial import __version__
from labial.errors import DataError, PathLike
from labial.files.outputs import writing
from labial.rig.description import CURVE_POINTS, PULSE_MAX, PULSE_MIN, Rig

#: Most outputs: the sketch selects them by a digit.
OUTPUTS_MAX = 10
#: Prints a pulse in degrees, rounded to hundredths.
_PRINT_DEGREES = """\
    const double place = (pulse - {start!r}) / {each!r};
    const long hundredths = (long)(100.0 * place + (place < 0.0 ? -0.5 : 0.5));
    Serial.print(hundredths < 0 ? "-" : "");
    Serial.print((int)(labs(hundredths) / 100));
    Serial.print(".");
    Serial.print((int)(labs(hundredths) / 10 % 10));
    Serial.print((int)(labs(hundredths) % 10));
"""


def sketch(rig: Rig) -> str:
    """The sketch's text. Raises DataError for a rig that moves no servos, or more than `OUTPUTS_MAX`."""
    if not rig.unit.servo:
        raise DataError(rig.path, None, f"--calibrate is for servos, and the unit is {rig.unit.name}")
    if len(rig.outputs) > OUTPUTS_MAX:
        raise DataError(rig.path, None, f"--calibrate is for at most {OUTPUTS_MAX} servos, not {len(rig.outputs)}")
    numbers, least, most = rig.numbers, round(PULSE_MIN), round(PULSE_MAX)
    unit, printing = "microseconds", "    Serial.print(pulse);\n"
    if numbers.degrees:
        least, most = least + 1, most - 1  # so that rounded degrees are within what a description may have
        unit, printing = "degrees", _PRINT_DEGREES.format(start=numbers.start, each=numbers.each)
    names = ", ".join(f'"{output.name}"' for output in rig.outputs)
    begins = ", ".join(str(min(max(round(output.neutral), least), most)) for output in rig.outputs)
    pins = ", ".join(str(9 + number) for number in range(len(rig.outputs)))
    return f"""/*
 * Finds the pulses of {rig.name}'s servos by commands over the serial line, 9600 baud. Take the horns off first.
 * Written by labial rig {__version__}.
 *
 *     0 .. 9   the servo that is moved          + -   by ten microseconds
 *     n        here the face rests              > <   by one
 *     c        here the lips just touch         g     to where the face rests, before n to the first pulse
 *     f        here the mouth is full open      p     prints what was set as lines of the description, {unit}
 *     l h      the least and the greatest pulse that the mechanics allow
 *     m12      here the mouth is open by 12: a whole number, in tenths of a millimetre or whatever you measure. Two to
 *              {CURVE_POINTS[1]} such points are the linkage's curve
 *
 * Servos at pins: change `pins`. Boards of the ESP32 family use ESP32Servo.h. Where a chip makes the pulses, change
 * show() and attach().
 */
#include <Servo.h>

#define OUTPUTS {len(rig.outputs)}

static const char *const names[OUTPUTS] = {{ {names} }};
static const int pins[OUTPUTS] = {{ {pins} }};
static const int firsts[OUTPUTS] = {{ {begins} }}; // microseconds
static int pulses[OUTPUTS];
static int found[OUTPUTS][5]; // neutral, closed, full, minimum, maximum; 0 where it was not set
static const char *const keys[5] = {{ "neutral", "closed", "full", "minimum", "maximum" }};
static Servo servos[OUTPUTS];
static int points[OUTPUTS]; // of the curve
static int measured[OUTPUTS][{CURVE_POINTS[1]}][2]; // pulse, opening
static int opening = -1; // while its digits come in
static int chosen = 0;

static void show(int output)
{{
    servos[output].writeMicroseconds(pulses[output]);
}}

// Boards differ in whether the first pulse is the one that was written before attach(), or the one after it.
static void attach(int output)
{{
    pulses[output] = firsts[output];
    show(output);
    servos[output].attach(pins[output]);
    show(output);
}}

static void printPulse(int pulse) // in {unit}
{{
{printing}}}

static void move(int output, int pulse)
{{
    pulses[output] = constrain(pulse, {least}, {most});
    show(output);
    Serial.print(names[output]);
    Serial.print(" ");
    printPulse(pulses[output]);
    Serial.println("");
}}

static void keep(int key)
{{
    found[chosen][key] = pulses[chosen];
    Serial.print(names[chosen]);
    Serial.print(" ");
    Serial.print(keys[key]);
    Serial.print(" = ");
    printPulse(pulses[chosen]);
    Serial.println("");
}}

static void keepOpening()
{{
    if (points[chosen] < {CURVE_POINTS[1]}) {{
        measured[chosen][points[chosen]][0] = pulses[chosen];
        measured[chosen][points[chosen]][1] = opening;
        points[chosen]++;
    }}
    Serial.print(names[chosen]);
    Serial.print(" open ");
    Serial.println(opening);
    opening = -1;
}}

static void printCurve(int output)
{{
    Serial.print("curve = [");
    for (int point = 0; point < points[output]; point++) {{
        Serial.print(point > 0 ? ", [" : "[");
        printPulse(measured[output][point][0]);
        Serial.print(", ");
        Serial.print(measured[output][point][1]);
        Serial.print("]");
    }}
    Serial.println("]");
}}

static void printAll()
{{
    for (int output = 0; output < OUTPUTS; output++) {{
        Serial.print("[output.");
        Serial.print(names[output]);
        Serial.println("]");
        for (int key = 0; key < 5; key++) {{
            if (found[output][key] != 0) {{
                Serial.print(keys[key]);
                Serial.print(" = ");
                printPulse(found[output][key]);
                Serial.println("");
            }}
        }}
        if (points[output] >= {CURVE_POINTS[0]})
            printCurve(output);
    }}
}}

void setup()
{{
    Serial.begin(9600);
    for (int output = 0; output < OUTPUTS; output++) {{
        attach(output);
        delay(500); // so that the servos do not draw their starting currents at once
    }}
    Serial.println("0 .. 9, + - > <, n c f l h, m, g, p");
}}

void loop()
{{
    if (!Serial.available())
        return;
    const int command = Serial.read();
    if (opening >= 0) {{
        if (command >= '0' && command <= '9') {{
            opening = constrain(10 * opening + (command - '0'), 0, 3000);
            return;
        }}
        keepOpening();
    }}
    if (command >= '0' && command < '0' + OUTPUTS) {{
        chosen = command - '0';
        Serial.println(names[chosen]);
        return;
    }}
    switch (command) {{
    case '+': case '-': case '>': case '<':
        move(chosen, pulses[chosen] + (command == '+' ? 10 : command == '-' ? -10 : command == '>' ? 1 : -1));
        break;
    case 'g':
        move(chosen, found[chosen][0] != 0 ? found[chosen][0] : firsts[chosen]);
        break;
    case 'n': case 'c': case 'f': case 'l': case 'h':
        keep(command == 'n' ? 0 : command == 'c' ? 1 : command == 'f' ? 2 : command == 'l' ? 3 : 4);
        break;
    case 'm':
        opening = 0;
        break;
    case 'p':
        printAll();
        break;
    default: // line ends, and what is no command
        break;
    }}
}}
"""


def write(rig: Rig, directory: PathLike) -> Path:
    """Writes NAME_calibrate/NAME_calibrate.ino, as the IDE requires, into `directory`; returns its path."""
    text = sketch(rig)
    folder = Path(directory) / f"{rig.name}_calibrate"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{rig.name}_calibrate.ino"
    with writing(path, "ascii") as out:
        out.write(text)
    return path
