"""The model file, which nothing but what was written satisfies, and the C that is generated of it."""

from __future__ import annotations

import dataclasses
import re
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from labial.errors import ModelError
from labial.evaluate.check import FRAMES, Comparison, device_frames
from labial.evaluate.loss import workspace_bytes
from labial.files.faps import CHANNELS
from labial.tables import emit
from labial.tables.layout import table_bytes
from labial.tables.model import load, save
from labial.tables.quantise import quantise
from models import archive, members_of, random_model, streams, without_floors
from packages import CC, LIBRARIES, SOURCE, needs_runtime, run, warnings


def build(folder: Path, *files: str) -> Path:
    program = folder / "program"
    run(CC, "-std=c99", *warnings("c"), f"-I{SOURCE / 'include'}", f"-I{folder}", *(folder / file for file in files),
        *LIBRARIES, "-o", program)
    return program


@pytest.mark.parametrize("name", ["speech_en", "laughter_synthetic"])
def test_bundled_tables_are_those_of_the_trained_models(tmp_path: Path, name: str) -> None:
    """Catches a model that was trained anew and not exported, and an exporter that changed under the tables."""
    for path in emit.write(quantise(load(SOURCE / "export" / "models" / f"{name}.npz"), name), tmp_path):
        assert path.read_bytes() == (SOURCE / "lib" / "models" / path.name).read_bytes(), path.name


@pytest.mark.parametrize(
    "name", ["", "9lives", "with space", "int", "labial_x", "a__b", "a-b", "_x", "class", "x" * 60, "ä"]
)
def test_refuses_names_that_c_cannot_use(tmp_path: Path, name: str) -> None:
    """Such a file would not compile, or would collide."""
    with pytest.raises(ModelError, match="no name for a model"):
        emit.write(quantise(random_model(1), name), tmp_path)
    assert not list(tmp_path.iterdir())


def entries_of(source: str) -> bytes:
    """The bytes of the entries in a NAME_names.c."""
    found = re.search(r"entries\[(\d+)\] = \{\n(.*?)\n\};", source, re.DOTALL)
    assert found
    values = bytes(ord(item[1]) if item[0] == "'" else int(item, 0) for item in re.findall(r"'.'|\w+", found[2]))
    assert len(values) == int(found[1])
    return values


def test_names_are_whole_entries() -> None:
    """lib/names.c walks from entry to entry and trusts the last one to end with the table."""
    exported = quantise(random_model(1), "some_model")
    longest = tuple((f"{i:04d}".ljust(31, "x"), i % len(exported.phonemes), ("ipa",)) for i in range(65535 // 33))
    for names in (exported.names, (), longest):
        data, at = entries_of(emit.names_source(replace(exported, names=names))), 0
        for name, phoneme, sets in names:
            length = data[at + 1] & 31
            assert data[at] == phoneme < len(exported.phonemes) and data[at + 1] & 0xe0 and sets
            assert data[at + 2 : at + 2 + length] == name.encode() and length > 0
            at += 2 + length
        assert at == len(data)
    for bad in ((("", 0, ("ipa",)),), (("x" * 32, 0, ("ipa",)),), (("\u0259" * 16, 0, ("ipa",)),), (("x", 0, ()),),
                (*longest, ("x" * 31, 0, ("ipa",)))):
        with pytest.raises(ModelError, match="names must have 1 to 31 bytes"):
            emit.names_source(replace(exported, names=bad))


def test_another_format_does_not_compile(tmp_path: Path) -> None:
    """Tables of another version must not be linked by accident."""
    emit.write(quantise(random_model(2), "some_model"), tmp_path)
    header = tmp_path / "some_model.h"
    header.write_text(header.read_text().replace("LABIAL_MODEL_FORMAT != 7", "LABIAL_MODEL_FORMAT != 6"))
    said = run(CC, "-std=c99", f"-I{SOURCE / 'include'}", "-fsyntax-only", tmp_path / "some_model.c", status=1)
    assert "run labial export again" in said


@pytest.mark.parametrize(("behind", "ahead", "apart", "needed"), [(6, 2, 3, 18), (1, 3, 5, 15), (0, 0, 1, 0)])
def test_a_library_that_remembers_too_few_phonemes_does_not_compile(
    tmp_path: Path, behind: int, ahead: int, apart: int, needed: int
) -> None:
    """Kernels that reach beyond LABIAL_REACH would read outside the library's memory; to either side."""
    lags = np.arange(-behind, ahead + 1) * apart
    kernel = np.zeros((9, len(lags), CHANNELS))
    model = without_floors(random_model(2))  # contacts reach three frames by themselves
    emit.write(quantise(replace(model, kernel=kernel, kernel_lag=lags), "some_model"), tmp_path)

    command = [CC, "-std=c99", "-fsyntax-only", f"-I{SOURCE / 'include'}", tmp_path / "some_model.c"]
    run(*command, f"-DLABIAL_REACH={needed}")
    if needed:
        said = run(*command, f"-DLABIAL_REACH={needed - 1}", status=1)
        assert f"some_model needs LABIAL_REACH of {needed} at least" in said


@needs_runtime
@pytest.mark.parametrize("method", [pytest.param("paper", marks=pytest.mark.slow), "labial"])
def test_binary_model_moves_as_the_compiled_one(tmp_path: Path, method: str) -> None:
    """A table in another order or of another width would be refused or move differently."""
    model = quantise(random_model(3, method), "some_model")
    stream = streams(9, random_model(3).boundary, 3)["ordinary"]
    emit.write(model, tmp_path)
    (tmp_path / "main.c").write_text("""
#include <stdio.h>
#include "some_model.h"
static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user; (void)frame;
    fwrite(faps, 2, LABIAL_CHANNELS, stdout);
}
int main(void)
{
    static uint32_t workspace[SOME_MODEL_WORKSPACE_SIZE / 4];
    static labial_t stream;
    unsigned phoneme, ms;
    if (labial_init(&stream, &some_model, workspace, sizeof workspace, on_frame, NULL) != LABIAL_OK) return 4;
    labial_exact(&stream, 1);
    while (scanf("%u %u", &phoneme, &ms) == 2) {
        while (labial_push(&stream, phoneme, ms) == LABIAL_ERROR_FULL) labial_tick(&stream);
    }
    labial_end(&stream);
    while (labial_tick(&stream) != LABIAL_DONE) { }
    return 0;
}
""")
    program = build(tmp_path, "main.c", "some_model.c")
    done = subprocess.run([str(program)], capture_output=True, check=True,
                          input=" ".join(f"{p} {ms}" for p, ms in stream).encode())
    assert np.array_equal(np.frombuffer(done.stdout, "<i2").reshape(-1, 13), device_frames(model, [stream])[0])


def test_sizes_that_are_printed_are_the_librarys(tmp_path: Path) -> None:
    """The report counts in Python what the C compiler lays out; of a descriptor, what it is with 32-bit pointers."""
    model = quantise(random_model(4), "some_model")
    emit.write(model, tmp_path)
    (tmp_path / "main.c").write_text("""
#include <stddef.h>
#include <stdio.h>
#include "some_model.h"
#define POINTERS(type, first) (unsigned)((sizeof(type) - offsetof(type, first)) / sizeof(void *))
int main(void)
{
    printf("%u %u %u %u %u ", (unsigned)SOME_MODEL_WORKSPACE_SIZE, (unsigned)labial_workspace_size(&some_model),
           (unsigned)(sizeof(labial_emission_t) + sizeof(labial_state_t)), (unsigned)sizeof(labial_phoneme_t),
           (unsigned)sizeof(labial_component_t));
    printf("%u %u %u %u", (unsigned)offsetof(labial_model_t, sources) + LABIAL_CHANNELS,
           POINTERS(labial_model_t, phonemes),
           (unsigned)offsetof(labial_channel_t, contact_weight) + 1, POINTERS(labial_channel_t, emissions));
    return 0;
}
""")
    said = run(build(tmp_path, "main.c", "some_model.c"))
    *sizes, head, pointers, channel_head, channel_pointers = map(int, said.split())
    assert sizes == [workspace_bytes(model.search_stride, len(model.centre))] * 2 + [12, 6, 6]

    def on_32_bits(head: int, pointers: int) -> int:
        return (head + 3) // 4 * 4 + 4 * pointers

    descriptors = len(model.centre) * on_32_bits(channel_head, channel_pointers) + on_32_bits(head, pointers)
    assert table_bytes(model)["descriptors"] == descriptors


# ---- The model file --------------------------------------------------------------------------------------------------


def test_round_trip_and_same_bytes(tmp_path: Path) -> None:
    """A lost field, or a time stamp in the archive, shows."""
    model = random_model(1)
    save(model, tmp_path / "a.npz")
    save(load(tmp_path / "a.npz"), tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    again = load(tmp_path / "b.npz")
    for item in dataclasses.fields(model):
        assert np.array_equal(getattr(model, item.name), getattr(again, item.name)), item.name


@pytest.mark.parametrize(("field", "value"), [
    ("shape", np.nan), ("kernel", np.inf), ("duration_variance", 0.0), ("state_precision", -1.0),
    ("state_anchor", -1e-9), ("log_transition", 0.5), ("viseme_class", 99), ("component_count", 0),
])
def test_refuses_values_out_of_range(field: str, value: float) -> None:
    """Each would otherwise come out as tables that mean nothing."""
    model = random_model(2)
    array = getattr(model, field).copy()
    array.flat[0] = value
    with pytest.raises(ModelError):
        dataclasses.replace(model, **{field: array})
    transition = model.log_transition.copy()
    transition[3, :, 5] = -np.inf  # a state that cannot be reached, on which the library's search relies
    with pytest.raises(ModelError, match="predecessor"):
        dataclasses.replace(model, log_transition=transition)


def test_names_the_file_that_is_no_model(tmp_path: Path) -> None:
    """Missing, truncated and foreign files end in a message with their name, not in a traceback."""
    path = tmp_path / "model.npz"
    with pytest.raises(ModelError, match="model.npz: No such file"):
        load(path)
    save(random_model(1), path)
    data, members = path.read_bytes(), members_of(path)
    lacking = archive({name: content for name, content in members.items() if name != "kernel.npy"})
    for damaged in (b"", b"junk", data[: len(data) // 2], lacking, archive({**members, "model.json": b"{}"})):
        path.write_bytes(damaged)
        with pytest.raises(ModelError, match="model.npz"):
            load(path)
    del members["emission_mean.npy"]  # whoever has a file of another version is told so, not that an array is missing
    path.write_bytes(archive({**members, "model.json": b'{"format": 6}'}))
    with pytest.raises(ModelError, match="format 6, but this version of labial reads formats 3 to 5"):
        load(path)


def test_a_model_of_format_3_is_read(tmp_path: Path) -> None:
    """Three arrays had other names; a model that somebody trained then is the same model."""
    path, former = tmp_path / "model.npz", tmp_path / "former.npz"
    model = random_model(1)
    save(model, path)
    names = {"viseme_class": "phoneme_class", "emission_mean": "decode_mean", "emission_variance": "decode_variance"}
    members = {name[: -len(".npy")]: content for name, content in members_of(path).items() if name.endswith(".npy")}
    former.write_bytes(archive({
        "model.json": members_of(path)["model.json"].replace(b'"format": 5', b'"format": 3'),
        **{f"{names.get(name, name)}.npy": content for name, content in members.items()}}))
    save(load(former), former)
    assert former.read_bytes() == path.read_bytes()


def test_the_distance_from_the_float_model_is_judged_in_enough_frames() -> None:
    """Would catch a check that fails on one short sentence, or passes a model whose rounding moves the lips."""
    parts = np.zeros((2, CHANNELS))
    for frames, share, problems in ((FRAMES - 1, 1.7, 0), (FRAMES, 1.7, CHANNELS), (FRAMES, 0.9, 0)):
        found = Comparison(frames, *parts, np.full(CHANNELS, share), np.full(CHANNELS, 100.0))
        assert len(found.failures()) == problems
        assert ("too few to judge" in found.table()) == (frames < FRAMES)
    wrong = Comparison(1, parts[0] + 2, *parts, np.full(CHANNELS, 100.0))
    assert len(wrong.failures()) == CHANNELS  # the library must equal its reference in every frame
