"""Lips from sound alone: features, network and conversion against plain definitions, the integers, and the C of models
of any size against these."""

from __future__ import annotations

import json
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any, Tuple

import hears
import numpy as np
import pytest

from labial.__main__ import main
from labial.errors import ModelError
from labial.files.faps import SIDES
from labial.hearing import convert, emit, integer, network
from labial.hearing import features as front
from labial.hearing.model import (
    CLASSES,
    CLOSED,
    PLANS,
    HearingModel,
    Memory,
    class_of,
    is_hearing,
    load,
    save,
    with_even_sides,
)
from labial.hearing.quantise import quantise, rounded
from labial.tables.model import load as load_speech
from models import archive, members_of
from packages import CC, SOURCE

STRICT = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wsign-conversion", "-Wundef", "-Wcast-qual",
          "-Wshadow", "-Werror"]  # fmt: skip
SANITIZED = [*STRICT, "-fsanitize=undefined", "-fno-sanitize-recover"]


def voice(seconds: float, seed: int = 0, rate: int = 16000) -> np.ndarray:
    """(N,) int16: bursts of harmonics and of noise over a little noise, with digital silence between."""
    rng = np.random.default_rng(seed)
    at = np.arange(int(seconds * rate)) / rate
    pitch = 110 + 30 * np.sin(2 * np.pi * 0.7 * at)
    tone = sum(np.sin(2 * np.pi * k * np.cumsum(pitch) / rate) / k for k in range(1, 20))
    swing = np.maximum(np.sin(2 * np.pi * 2.3 * at), 0) + 0.3 * np.maximum(np.sin(2 * np.pi * 0.9 * at), 0)
    noise = rng.normal(size=len(at)) * (np.sin(2 * np.pi * 1.1 * at) > 0.8)
    breath = rng.normal(size=len(at)) * 40
    return np.clip((tone * swing * 4000 + noise * 2500 + breath) * (at % 3 < 2.4), -32768, 32767).astype(np.int16)


#: Most bytes of each network's tables.
LARGEST = {"small": 23000, "large": 34500, "host": 182000, "ahead": 184000}


def random_model(units: int, memories: Tuple[Memory, ...], classes: int = 5, seed: int = 0) -> HearingModel:
    """A model of random weights."""
    rng = np.random.default_rng(seed)

    def drawn(*shape: int, scale: float = 1.0) -> np.ndarray:
        return (rng.normal(size=shape) * scale / np.sqrt(shape[-1])).astype(np.float32)

    blocks = range(len(memories))
    return HearingModel(
        memories, tuple(drawn(units, units if k else 48, scale=1.5) for k in blocks),
        tuple(drawn(units) for _ in blocks), tuple(drawn(units, memory.taps) for memory in memories),
        drawn(units, units, scale=1.5), drawn(units), drawn(classes, units), drawn(classes), drawn(units), drawn(1),
        drawn(13, units), drawn(13), tuple(f"C{k}" for k in range(classes)), drawn(13, scale=100.0),
        np.abs(drawn(13, scale=300.0)) + 1, drawn(13, scale=100.0), np.linspace(0.0, 1.0, 13, dtype=np.float32),
        -0.5, 0.3,
    )  # fmt: skip


def features_of(energies: np.ndarray) -> np.ndarray:
    """The integers' features of log energies."""
    silent = energies.mean(axis=1) <= 1.5 * 256
    return integer.normalise(energies, integer.levels(energies, silent, integer.BEGIN).hops)


# ---- The front end ---------------------------------------------------------------------------------------------------


def test_energies_are_those_of_the_definition() -> None:
    """Catches a window that begins elsewhere, and wrong bins or bands: sums written out for a few hops."""
    sound = voice(1.0)
    found = front.log_energies(sound)
    assert found.shape == (100, 24)
    shape = np.sin(np.pi * np.arange(256) / 256) ** 2
    edges = np.linspace(1127 * np.log(1 + 120 / 700), 1127 * np.log(1 + 7600 / 700), 26)
    for hop in (0, 1, 37, 99):
        end = (hop + 1) * 160
        window = np.concatenate([np.full(256, sound[0]), sound[:end]])[-256:] * shape
        energy = np.zeros(24)
        for k in range(129):
            power = abs(np.sum(window * np.exp(-2j * np.pi * k * np.arange(256) / 256))) ** 2
            for b in range(24):
                energy[b] += power * np.interp(1127 * np.log(1 + k * 62.5 / 700), edges[b : b + 3], [0, 1, 0])
        assert np.abs(found[hop] - np.log2(np.maximum(energy, 2))).max() < 1e-3


def test_features_follow_the_level() -> None:
    """Catches a level that looks ahead, falls too fast, or keeps a quiet voice quiet: 36 dB less give the same."""
    sound = voice(4.0)
    energies = front.log_energies(sound)
    for begin, levels in ((13.0, front.crop_levels(energies)), (26.0, front.levels(energies))):
        level, wanted = begin, []
        for hop in energies:
            level = max(level - 0.008, 13.0, float(hop.mean()))
            wanted.append(level)
        assert np.abs(levels - wanted)[30:].max() < 1e-4  # until then the one of a sound may fall faster
    found = integer.levels(integer.log_energies(sound), np.ptp(sound.reshape(-1, 160), axis=1) <= 32, integer.BEGIN)
    assert np.abs(found.hops / 256 - front.levels(energies)).max() < 0.05
    loud = front.features(sound)
    assert np.abs(front.features(sound[: 320 * 60]) - loud[:60]).max() < 1e-3
    spoken = np.flatnonzero(np.abs(sound.reshape(-1, 320).astype(int)).max(axis=1) > 8000)
    faint = front.log_energies((sound // 64).astype(np.int16))
    quiet = front.relative_to(front.levels(faint, 14.0), faint).reshape(loud.shape)
    assert np.sqrt(np.mean((quiet - loud)[spoken] ** 2)) < 0.06
    assert loud.min() >= -2.25 and loud.max() <= 2.75


@pytest.mark.parametrize("sound", [np.zeros(5000), np.full(4800, 8520), np.zeros(0)])
def test_silence_has_the_least_features(sound: np.ndarray) -> None:
    """Catches silence, and an offset, that sound like anything, at their ends as well."""
    found = front.features(sound.astype(np.int16))
    assert found.shape == (-(-len(sound) // 320), 48)
    assert (found == -2.25).all()
    energies = integer.log_energies(sound.astype(np.int64))
    assert (features_of(energies) == -1152).all()


@pytest.mark.parametrize("rate", sorted(convert.RATES))
def test_conversion_keeps_tones_and_lengths(rate: int) -> None:
    """Catches a filter of another gain or delay, in floating point and in integers."""
    tone = 9000 * np.sin(2 * np.pi * 700 * np.arange(rate // 2) / rate)
    wanted = 9000 * np.sin(2 * np.pi * 700 * np.arange(8000) / 16000)
    found = convert.convert(tone, rate)
    assert len(found) == 8000 == convert.converted_count(rate // 2, rate)
    assert np.abs(found - wanted)[100:-100].max() < 120
    whole = np.rint(tone).astype(np.int16)
    assert np.abs(integer.convert(whole, rate) - convert.convert(whole, rate)).max() < 4
    both = np.stack([whole, whole], axis=1)
    assert np.array_equal(integer.convert(both, rate), integer.convert(whole, rate))


@pytest.mark.parametrize("rate", sorted(convert.RATES))
def test_conversion_keeps_offsets(rate: int) -> None:
    """Catches an offset that begins or ends with a step, or becomes a tone; in floating point it is only added."""
    sound = voice(0.7, rate=rate)[rate // 10 : rate // 2].astype(float) / 2
    assert np.abs(convert.convert(sound + 9830, rate) - convert.convert(sound, rate) - 9830).max() < 1e-6
    constant = integer.convert(np.full(rate // 2, 9830, np.int16), rate)
    assert len(constant) == 8000 and np.ptp(constant) <= 3 and abs(constant[0] - 9830) <= 2
    assert convert.convert(np.zeros(0), rate).shape == (0,)


def test_an_offset_changes_no_lips() -> None:
    """Catches an offset that the float network hears at the ends of a sound."""
    model = random_model(PLANS["small"].units, PLANS["small"].memories)
    sound = voice(0.7)[500:9000].astype(float) / 2
    wanted, found = network.hear(model, sound), network.hear(model, sound + 9830)
    assert np.abs(wanted.faps).max() > 50 and np.abs(found.faps - wanted.faps).max() < 0.5


# ---- The network -----------------------------------------------------------------------------------------------------


def test_the_network_is_that_of_the_definition() -> None:
    """Catches taps in the wrong order or at the wrong distance, and inputs added too late: every sum written out."""
    model = random_model(4, (Memory(2, 1, 1), Memory(1, 2, 3)))
    heard = np.random.default_rng(1).normal(size=(20, 48)).astype(np.float32)
    x = [list(map(float, row)) for row in heard]
    for k, (past, ahead, dilation) in enumerate(model.memories):
        y = [[max(0.0, sum(w * v for w, v in zip(row, x[t])) + b) for row, b in zip(model.dense[k], model.bias[k])]
             for t in range(20)]
        z = [[sum(model.memory[k][u, past + j] * y[t + j * dilation][u] for j in range(-past, ahead + 1)
                  if 0 <= t + j * dilation < 20) + (x[t][u] if k else 0.0) for u in range(4)] for t in range(20)]
        x = z
    last = np.maximum(np.array(x) @ model.last.T + model.last_bias, 0)
    found = network.run(model, heard)
    assert np.abs(found.scores - (last @ model.class_weight.T + model.class_bias)).max() < 1e-4
    assert np.abs(found.closed - (last @ model.closed_weight + model.closed_bias[0])).max() < 1e-4
    faps = model.fap_mean + model.fap_scale * (last @ model.fap_weight.T + model.fap_bias)
    assert np.abs(found.faps - faps).max() < 1e-2


@pytest.mark.parametrize("name", sorted(PLANS))
def test_integers_are_near_the_float_network(name: str) -> None:
    """Catches a shift too many: with the weights that the tables hold, features differ by .01, scores by .04 and FAPs
    by 1 % of their spread, in the root mean square; the models fit their flash and their delay."""
    plan = PLANS[name]
    model = random_model(plan.units, plan.memories, len(CLASSES))
    held = replace(model, dense=tuple(rounded(w).astype(np.float32) for w in model.dense),
                   memory=tuple(rounded(w).astype(np.float32) for w in model.memory),
                   last=rounded(model.last).astype(np.float32),
                   class_weight=rounded(model.class_weight).astype(np.float32),
                   fap_weight=rounded(model.fap_weight).astype(np.float32))
    sound = voice(5.0)
    for heard in (sound, np.clip(20 * sound.astype(int), -32768, 32767).astype(np.int16)):  # clipped, louder than it is
        features = features_of(integer.log_energies(heard)) / 512
        assert np.sqrt(np.mean((features.reshape(250, 48) - front.features(heard)) ** 2)) < 0.01
    wanted, found = network.hear(held, sound), integer.hear(quantise(model, "x"), sound)
    assert found.faps.shape == wanted.faps.shape == (250, 13)
    assert np.sqrt(np.mean((found.scores / 512 - wanted.scores) ** 2)) < 0.04
    assert np.sqrt(np.mean((found.faps - wanted.faps) ** 2)) < 0.01 * wanted.faps.std()
    assert emit.flash_bytes(quantise(model, "x")) < LARGEST[name] and plan.ahead == (12 if name == "ahead" else 4)


def test_plans_and_classes() -> None:
    """Catches a phoneme of the speech model without a lip class."""
    phonemes = load_speech("speech_en").phonemes
    assert {class_of(phoneme) for phoneme in phonemes} == set(CLASSES)
    assert [phoneme for phoneme in phonemes if class_of(phoneme) == CLOSED] == ["B", "M", "P"]


# ---- The C -----------------------------------------------------------------------------------------------------------

PROGRAM = """\
#include <stdio.h>
#include "some_model.h"

static labial_hear_t hear;
static uint32_t workspace[SOME_MODEL_WORKSPACE_SIZE / 4];
static int16_t samples[1 << 17];

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    unsigned k;
    (void)user;
    (void)frame;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        printf("%d ", faps[k]);
    printf("\\n");
}

static void on_class(void *user, unsigned shown, uint32_t frame, uint32_t frames)
{
    (void)user;
    fprintf(stderr, "%u %u %u %s\\n", shown, (unsigned)frame, (unsigned)frames, some_model_classes[shown]);
}

int main(void)
{
    const size_t count = fread(samples, 2, sizeof samples / 2, stdin);
    if (labial_hear_workspace_size(&some_model) != sizeof workspace ||
        labial_hear_init(&hear, &some_model, RATE, 1, workspace, sizeof workspace, on_frame, NULL) != LABIAL_OK)
        return 1;
    labial_hear_classes(&hear, on_class);
    labial_hear_push(&hear, samples, count / 3);
    labial_hear_push(&hear, samples + count / 3, count - count / 3);
    return labial_hear_end(&hear) != LABIAL_OK;
}
"""

MODELS = {
    "small": (PLANS["small"].units, PLANS["small"].memories, 26, 16000),
    "large": (PLANS["large"].units, PLANS["large"].memories, 26, 24000),
    "least": (4, (Memory(0, 1, 1),), 2, 8000),
    "without delay": (8, (Memory(3, 0, 1), Memory(1, 0, 2)), 3, 44100),
    "widest": (128, (Memory(14, 1, 1), Memory(0, 3, 5)), 64, 48000),
    "deepest": (12, (Memory(1, 1, 1),) * 8, 7, 22050),
}


@pytest.fixture(scope="module")
def sanitized(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """What hears, compiled with `SANITIZED`."""
    folder = tmp_path_factory.mktemp("sanitized")
    sources = [*sorted((SOURCE / "lib").glob("hear*.c")), *(SOURCE / "lib" / name for name in ("fade.c", "fixed.c"))]
    subprocess.run([CC, *SANITIZED, f"-I{SOURCE / 'include'}", "-c", *sources], cwd=folder, check=True)
    return [str(path) for path in sorted(folder.glob("*.o"))]


@pytest.mark.parametrize("name", [
    "large", "least", "widest",
    *(pytest.param(name, marks=pytest.mark.slow) for name in ("small", "without delay", "deepest")),
])  # fmt: skip
def test_any_model_gives_the_exporters_bits_in_c(tmp_path: Path, sanitized: list[str], name: str) -> None:
    """Catches sizes that the library does not take from the model, and tables that are written wrong."""
    units, memories, classes, rate = MODELS[name]
    tables = quantise(random_model(units, memories, classes, seed=3), "some_model")
    emit.write(tables, tmp_path)
    (tmp_path / "program.c").write_text(PROGRAM)
    subprocess.run([CC, *SANITIZED, f"-DRATE={rate}", f"-I{SOURCE / 'include'}", f"-I{tmp_path}",
                    str(tmp_path / "program.c"), str(tmp_path / "some_model.c"), *sanitized,
                    "-o", str(tmp_path / "program")], check=True)
    sound = voice(1.3, seed=2, rate=rate)
    sound[len(sound) // 2 :] = np.clip(20 * sound[len(sound) // 2 :].astype(int), -32768, 32767)
    done = subprocess.run([tmp_path / "program"], input=sound.astype("<i2").tobytes(), capture_output=True, check=True)
    wanted = integer.delivered(tables, sound, rate)
    assert np.array_equal(np.array(done.stdout.split(), dtype=int).reshape(-1, 13), wanted.faps)
    told = [[*map(int, line.split()[:3]), line.split()[3]] for line in done.stderr.decode().splitlines()]
    assert told == [[*row, tables.classes[row[0]]] for row in hears.stretches(wanted.scores)]


def test_what_is_delivered_rests_and_loses_nothing_of_the_sound() -> None:
    """From the sound's first frame to its last one it is what the network tells, however long the silence before and
    after; catches a face that leaves rest too late, or comes to rest in a gap of speech. Then it comes to rest."""
    units, memories, classes, _ = MODELS["small"]
    tables = quantise(random_model(units, memories, classes, seed=3), "some_model")
    sound = voice(1.2, seed=4)
    sound[9600:11200] = 7  # a gap of 100 ms
    for before, after in ((8000, 8000), (2560, 1600), (0, 0)):
        whole = np.concatenate([np.zeros(before, np.int16), sound, np.zeros(after, np.int16)])
        heard, told = integer.hear(tables, whole).faps, integer.delivered(tables, whole).faps
        first, last = before // 320, (before + len(sound)) // 320
        begin = first if before > 2600 else max(first, 8)
        assert np.array_equal(told[begin:last], heard[begin:last])
        assert np.abs(heard[:first]).max(initial=1) > 0 and not told[: max(first - 5, 0)].any()
        assert not told[last + 2 + 5 : len(heard)].any() and np.abs(told[-1]).max() <= 8
        assert np.array_equal(integer.delivered(tables, whole, exact=True).faps, told[: len(heard)])
    share = np.array([25, 92, 189, 304, 425, 540, 637, 704]) / 729  # of the first eight frames, worked by hand
    assert np.abs(told[:8] - heard[:8] * share[:, None] * np.minimum(1, [[0.104], [0.352], [0.648], [0.896], [1], [1],
                                                                         [1], [1]])).max() <= 1.5


def test_tables_and_fixtures_are_written(tmp_path: Path) -> None:
    """Catches tables and laughs that changed in Python alone: run python -m labial.hearing.emit lib, or hears.py."""
    emit.write_tables(tmp_path)
    for path in tmp_path.iterdir():
        assert path.read_bytes() == (SOURCE / "lib" / path.name).read_bytes(), path.name
    for name, text in hears.files().items():
        assert (SOURCE / "tests" / "c" / name).read_text(encoding="ascii") == text, name


@pytest.mark.parametrize("path", sorted((SOURCE / "export" / "models").glob("hear_*.npz")), ids=lambda path: path.stem)
def test_bundled_tables_are_those_of_the_trained_models(tmp_path: Path, path: Path) -> None:
    """Catches a model that was trained anew and not exported, and an exporter that changed under the tables."""
    for written in emit.write(quantise(load(path), path.stem), tmp_path):
        assert written.read_bytes() == (SOURCE / "lib" / "models" / written.name).read_bytes(), written.name


# ---- Models ----------------------------------------------------------------------------------------------------------


def small() -> HearingModel:
    """A model that is quick to write."""
    return random_model(4, (Memory(1, 1, 1), Memory(2, 1, 2)))


@pytest.mark.skipif(not CC, reason="no C compiler")
@pytest.mark.parametrize("name", ["hear_host", "hear_ahead", "hear_small"])
def test_a_model_without_room_says_what_it_needs(tmp_path: Path, name: str) -> None:
    """In a default build the compiler names the limit that a large model needs, where it is used; a file that only
    includes its header compiles, as does everything in a build with room."""
    program = tmp_path / "main.c"
    program.write_text(f"#include \"{name}.h\"\n#ifdef USE\nconst void *const used = &{name};\n#endif\n")
    folders = [f"-I{SOURCE / 'include'}", f"-I{SOURCE / 'lib' / 'models'}"]
    command = [CC, "-std=c99", "-fsyntax-only", *folders, str(program)]
    for options, fits in (([], True), (["-DUSE"], name == "hear_small"),
                          (["-DUSE", "-DLABIAL_HEAR_UNITS_MAX=192"], True)):
        made = subprocess.run([*command, *options], capture_output=True, text=True, check=False)
        assert (made.returncode == 0) == fits, made.stderr
        assert fits or f"{name}_needs_a_build_with_LABIAL_HEAR_UNITS_MAX_192" in made.stderr


def test_a_model_is_read_as_it_was_written(tmp_path: Path) -> None:
    """Catches an array that is left out, and a file that differs from one run to the next."""
    model = replace(small(), attribution="Made by nobody.", training={"steps": 3})
    for name in ("a.npz", "b.npz"):
        save(model, tmp_path / name)
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    again = load(tmp_path / "a.npz")
    assert again.plan == model.plan and again.classes == model.classes and again.training == {"steps": 3}
    assert emit.source(quantise(again, "x")) == emit.source(quantise(model, "x"))
    assert is_hearing(tmp_path / "a.npz")
    assert not is_hearing(tmp_path / "none.npz") and not is_hearing(SOURCE / "export/models/speech_en.npz")
    with pytest.raises(ModelError, match="format 2"):
        load_speech(tmp_path / "a.npz")
    with pytest.raises(ModelError, match="speech_en.npz: not a model of hearing: model.json: its kind is not hearing"):
        load(SOURCE / "export/models/speech_en.npz")


@pytest.mark.parametrize("changes, message", [
    ({"memories": ()}, "0 blocks"),
    ({"last_bias": np.zeros(5, np.float32)}, "5 units, not a multiple of 4"),
    ({"classes": ("A", "A", "B", "C", "D")}, "different names"),
    ({"classes": ("C0", "C1", "\n", "C3", "C4")}, "not printable"),
    ({"closing": np.full(13, 1.5, np.float32)}, "closing has a value that is not within 0 .. 1"),
    ({"memories": (Memory(1, 1, 0), Memory(2, 1, 2))}, "reaches 1 back and 1 ahead, times 0"),
    ({"memories": (Memory(1, 1, 1), Memory(2, 26, 1))}, "27 frames ahead"),
    ({"dense": ()}, "dense has 0 arrays"),
    ({"last": np.zeros((4, 5), np.float32)}, r"last has shape \(4, 5\), not \(4, 4\)"),
    ({"closed": np.zeros(13, int)}, "closed has the type int64"),
    ({"fap_mean": np.full(13, np.nan, np.float32)}, "fap_mean has a value that is not within -2000"),
    ({"class_bias": np.full(5, 65, np.float32)}, "class_bias has a value that is not within -64"),
    ({"fap_scale": np.zeros(13, np.float32)}, "not positive"),
    ({"close_from": 0.3}, "not in order"),
    ({"close_to": float("nan")}, "not in order"),
])
def test_an_inconsistent_model_is_refused(changes: Any, message: str) -> None:
    """Catches a model whose tables would not fit each other, or the library."""
    with pytest.raises(ModelError, match=message):
        replace(small(), **changes)


@pytest.mark.parametrize("change, message", [
    ({"kind": "speech"}, "its kind is not hearing"),
    ({"format": 1}, "format 1, but this version of labial reads format 2"),
    ({"classes": "ABC"}, "classes is not a list of texts"),
    ({"memories": [[1, 2]]}, "memories is not a list"),
    ({"memories": [[1, 2, 0.5]]}, "memories is not a list"),
    ({"close_to": "1"}, "close_to is not a number"),
    ({"training": 3}, "training is not an object"),
    ({"attribution": None}, "attribution is not text"),
])
def test_a_file_with_wrong_texts_is_refused(tmp_path: Path, change: Any, message: str) -> None:
    """Catches a file that is read as if its JSON could be trusted."""
    save(small(), tmp_path / "model.npz")
    members = members_of(tmp_path / "model.npz")
    members["model.json"] = json.dumps({**json.loads(members["model.json"]), **change}).encode()
    (tmp_path / "wrong.npz").write_bytes(archive(members))
    with pytest.raises(ModelError, match=f"wrong.npz: not a model of hearing: .*{message}"):
        load(tmp_path / "wrong.npz")


@pytest.mark.parametrize("left_out", ["model.json", "dense_1.npy", "closed_weight.npy"])
def test_a_file_without_a_member_is_refused(tmp_path: Path, left_out: str) -> None:
    """Catches a member that is needed and not asked for."""
    save(small(), tmp_path / "model.npz")
    members = members_of(tmp_path / "model.npz")
    del members[left_out]
    (tmp_path / "less.npz").write_bytes(archive(members))
    with pytest.raises(ModelError, match=f"it holds no {left_out}"):
        load(tmp_path / "less.npz")
    (tmp_path / "text.npz").write_text("text")
    for name, message in (("text", "not a model of hearing"), ("none", "No such file")):
        with pytest.raises(ModelError, match=f"{name}.npz: {message}"):
            load(tmp_path / f"{name}.npz")


def test_tables_that_the_library_cannot_hold_are_refused(tmp_path: Path) -> None:
    """Catches a model that would write beyond the library's memory."""
    for memories, message in (((Memory(16, 0, 1),), "17 taps"), ((Memory(0, 0, 1),), "1 taps"),
                              ((Memory(15, 0, 4),) * 5, "rows together")):
        with pytest.raises(ModelError, match=message):
            emit.write(quantise(random_model(4, memories), "x"), tmp_path / "c")
    wide = replace(small(), class_bias=np.full(5, -63.99, np.float32))
    assert quantise(wide, "x").heads.bias.min() == -32763
    with pytest.raises(ModelError, match="a bias of 64"):
        quantise(replace(small(), class_bias=np.full(5, 64, np.float32)), "x")
    with pytest.raises(ModelError, match="other characters"):
        emit.source(quantise(replace(small(), classes=("a b", "C1", "C2", "C3", "C4")), "x"))


def test_export_writes_a_model_of_hearing(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """Catches a model of hearing that is taken for one of speech."""
    save(small(), tmp_path / "hear.npz")
    assert main(["export", str(tmp_path / "hear.npz"), "--name", "ears", "-o", str(tmp_path / "c")]) == 0
    assert sorted(path.name for path in (tmp_path / "c").iterdir()) == ["ears.c", "ears.h"]
    assert "flash" in capsys.readouterr().out
    assert main(["export", str(tmp_path / "hear.npz"), "--name", "ears", "--blob", "-o", str(tmp_path / "d")]) == 1
    assert "not for a model of hearing" in capsys.readouterr().err


def test_both_sides_are_their_mean() -> None:
    """Would catch a mean of rows that forgets their scales, or sides that differ after it."""
    model = random_model(8, (Memory(2, 1, 1),), seed=5)
    even = with_even_sides(replace(model, fap_scale=np.linspace(40, 90, 13, dtype=np.float32)))
    heard = np.random.default_rng(2).normal(0, 1, (50, 48)).astype(np.float32)
    before = network.run(replace(model, fap_scale=np.linspace(40, 90, 13, dtype=np.float32)), heard).faps
    after = network.run(even, heard).faps
    for left, right in SIDES:
        np.testing.assert_allclose(after[:, left], (before[:, left] + before[:, right]) / 2, atol=1e-2)
        for name in ("fap_weight", "fap_bias", "fap_mean", "fap_scale", "closed", "closing"):
            np.testing.assert_array_equal(getattr(even, name)[left], getattr(even, name)[right])
