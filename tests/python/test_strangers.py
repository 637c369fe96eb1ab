"""Files of strangers that are small and ask for much: whatever reads one refuses it in a sentence that names it, within
`SECONDS` of the processor's time and `MEMORY` bytes. SECURITY.md lists the kinds of files and their limits."""

from __future__ import annotations

import base64
import io
import json
import os
import random
import shutil
import signal
import struct
import sys
import time
import warnings
import zipfile
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Tuple, Union

import numpy as np
import pytest

from avatars import document_of, glb, made_head
from labial.files import limits
from labial.files.frames import CSV_HEAD
from labial.tables.model import save
from labial.tables.phones import read_stream
from models import archive, members_of, random_model, write_motion
from packages import needs_runtime
from test_cli import FACE, LAB, Told, corpus, limited
from test_record import LAB as TALK
from test_record import talking, turned
from test_see import stand_in  # noqa: F401, a fixture
from test_timings import damaged

pytestmark = [pytest.mark.slow,
              pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are those of Linux")]

#: Seconds of the processor and bytes of memory, beyond what the test has, that a file of 1 MB may take.
SECONDS, MEMORY = 10, 500_000_000
#: Bytes of the largest file that is made here, but for one of a million nodes.
LARGEST = 1_000_000


@pytest.fixture(scope="module", autouse=True)
def imported() -> None:
    """What commands import is in memory before it is limited."""
    import scipy.optimize  # noqa: F401

    import labial.fit.fit
    import labial.see.plot  # noqa: F401
    import labial.sound.samples  # noqa: F401


@pytest.fixture(autouse=True)
def bounds() -> Iterator[None]:
    """Ends what takes too much memory or time."""
    with limited(SECONDS, MEMORY):
        yield


class Brief(Told):
    """The line of an error, without its ``labial: ``, which is no page of text and has nothing to do with memory."""

    def __call__(self, *arguments: object) -> str:
        said = super().__call__(*arguments)
        assert len(said) <= 2100 and "memory" not in said, said
        return said[len("labial: "):]


@pytest.fixture
def told(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Told:
    monkeypatch.chdir(tmp_path)
    write_motion(tmp_path / "f.csv", np.arange(9) / 50, np.zeros((9, 13)))
    return Brief(capsys)


# ---- Avatars ---------------------------------------------------------------------------------------------------------

#: A document and its binary part, changed.
Spoiled = Tuple[Dict[str, Any], bytes]


def _head() -> Spoiled:
    return document_of(*made_head())


def _triangle() -> Spoiled:
    corners = np.eye(3)
    return document_of(corners, np.array([[0, 1, 2]]), {"jawOpen": corners})


def _changed(change: Callable[[Dict[str, Any]], object], head: Callable[[], Spoiled] = _head) -> Callable[[], Spoiled]:
    def made() -> Spoiled:
        document, binary = head()
        change(document)
        return document, binary

    return made


def _shapes(count: int) -> Callable[[Dict[str, Any]], None]:
    """So many shapes, all of one accessor."""
    def change(document: Dict[str, Any]) -> None:
        document["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": 0}] * count
        document["meshes"][0]["extras"] = {"targetNames": ["jawOpen", *(f"s{n}" for n in range(count - 1))]}

    return change


def _without_views(document: Dict[str, Any]) -> None:
    """2^24 items in 60 bytes, and each shape asks for them again."""
    document["accessors"] = [{"componentType": 5126, "type": "VEC3", "count": 1 << 24}]
    document["meshes"][0]["primitives"][0] = {"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}] * 20}


def _with(*keys: Any, to: Any, head: Callable[[], Spoiled] = _head) -> Callable[[], Spoiled]:
    """With another value deep in the document."""
    def change(document: Any) -> None:
        for key in keys[:-1]:
            document = document.setdefault(key, {}) if isinstance(document, dict) else document[key]
        document[keys[-1]] = to

    return _changed(change, head)


def _sparse(**values: Any) -> Callable[[], Spoiled]:
    given = {"count": 1, "indices": {"bufferView": 1, "componentType": 5125}, "values": {"bufferView": 0}, **values}
    return _with("accessors", 2, "sparse", to=given)


def _lattice(wide: float) -> Spoiled:
    """40,000 vertices in a slab this wide, the lower half of which goes down: all are on the midline."""
    rng = np.random.default_rng(3)
    vertices = rng.uniform(-1.0, 1.0, (40_000, 3)) * (wide, 60.0, 20.0)
    vertices[:2, 0] = -60.0, 60.0
    below = (vertices[:, 1] < 0.0)[:, None]
    triangles = rng.integers(0, len(vertices), (4_000, 3))
    return document_of(vertices, triangles, {"jawOpen": -30.0 * below * np.eye(3)[1]}, sparse=True)


def _fan() -> Spoiled:
    """The made head, with one vertex of its lips the neighbour of all others."""
    vertices, triangles, shapes = made_head()
    middle = int(np.argmin(np.abs(vertices - (0.0, 0.3, vertices[:, 2].max())).sum(axis=1)))
    others = np.arange(len(vertices) - 1)
    fan = np.stack([np.full(len(others), middle), others, others + 1], axis=1)
    few = {name: shapes[name] for name in ("jawOpen", "mouthClose", "mouthPucker", "mouthSmileLeft")}
    return document_of(vertices, np.concatenate([triangles, fan]), few, sparse=True)


AVATARS: Dict[str, Tuple[Callable[[], Spoiled], str]] = {
    "no buffer view": (_changed(_without_views), "its accessors unpack to"),
    "one accessor, many shapes": (_changed(_shapes(18_000)), "its accessors unpack to"),
    "many shapes": (_changed(_shapes(1_500)), "the mesh 'head' has 1,500 shapes, more than the 1,000 that are read"),
    "shapes without vertices": (_with("meshes", 0, "primitives", 0, "targets", to=[{}] * 60_000),
                                "its accessors unpack to"),
    "a level of lists": (_with("nodes", 0, "children", to=[[[]]]), "is not a whole .glb"),
    "a mesh of many shapes": (_changed(_shapes(1_001), _triangle), "the mesh 'head' has 1,001 shapes, more than"),
    "many meshes": (_with(
        "meshes", to=[{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}]}]}] * 3_000,
        head=_with("nodes", to=[{"mesh": n} for n in range(3_000)])), "its accessors unpack to"),
    "a million nodes": (_with("nodes", to=[{"mesh": 0}] + [{}] * 1_000_000),
                        "it has 1,000,001 nodes, more than the 20,000 that are read"),
    "deep nodes": (_with("nodes", to=[{"mesh": 0}, *({"children": [n + 2]} for n in range(15_000)), {}]),
                   "its nodes are nested in 15,001 levels, more than the 200 that are read"),
    "a circle of nodes": (_with("nodes", to=[{"mesh": 0, "children": [1]}, {"children": [0]}]), "no tree"),
    "a circle elsewhere": (_with("nodes", to=[{"mesh": 0}, {"children": [2]}, {"children": [1]}]), "no tree"),
    "nodes that double": (_with("nodes", to=[{"mesh": 0}, {"children": [0, 0]}]), "no tree"),
    "a child that is none": (_with("nodes", 0, "children", to=[7]), "no tree"),
    "a child that is text": (_with("nodes", 0, "children", to="0"), "is not a whole .glb"),
    "sparse, too many": (_sparse(count=10**9), "accessor 2 changes 1000000000 of"),
    "sparse, beyond": (_sparse(values={"bufferView": 99}), "is not a whole .glb"),
    "sparse, backwards": (_sparse(count=-1), "is not a whole .glb"),
    "sparse, far": (_sparse(indices={"bufferView": 0, "componentType": 5125}), "is not a whole .glb"),
    "stride of 1": (_with("bufferViews", 0, "byteStride", to=1), "goes beyond its buffer"),
    "stride of 10^18": (_with("bufferViews", 0, "byteStride", to=10**18), "goes beyond its buffer"),
    "a view before its buffer": (_with("bufferViews", 0, "byteOffset", to=-8), "goes beyond its buffer"),
    "no count": (_with("accessors", 0, "count", to=-1), "accessor 0 has -1 items"),
    "half a count": (_with("accessors", 0, "count", to=2.5), "accessor 0 has 2.5 items"),
    "another type": (_with("accessors", 0, "type", to="VEC9"), "is not a whole .glb"),
    "vertices of one number": (_with("accessors", 0, "type", to="SCALAR"), "accessor 0 has no vectors"),
    "fractions of vertices": (_with("accessors", 1, "componentType", to=5126), "has no vertex numbers"),
    "scale": (_with("nodes", 0, "scale", to=[1e300] * 3), "the place of a node is not finite"),
    "far away": (_with("nodes", 0, "translation", to=[1e9] * 3), "a coordinate is beyond 1e+06"),
    "a huge number": (_with("nodes", 0, "translation", to=[10**400] * 3), "is not a whole .glb"),
    "NaN": (_with("nodes", 0, "translation", to=[float("nan")] * 3), "NaN is no number of JSON"),
    "a point": (_with("accessors", 0, "bufferView", to=None), "the mesh 'head' is 0 wide, not a face"),
    "a plane": (_with("nodes", 0, "scale", to=[0.0, 1.0, 1.0]), "moves nothing that is wide"),
    "no base64": (_with("buffers", 0, "uri", to="data:;base64,()"), "buffer 0 is no base64"),
    "another folder": (_with("buffers", 0, "uri", to="/etc/passwd"), "lies outside the file's folder"),
    "the folder": (_with("buffers", 0, "uri", to="."), "lies outside the file's folder"),
    "long names": (_with("nodes", 0, "name", to="n" * 300_000), ""),
    "binds": (_with("extensions", "VRM", "blendShapeMaster", to={"blendShapeGroups": [
        {"presetName": "a", "binds": [{"mesh": 0, "index": 0, "weight": 1}] * 10_000}]}), ""),
    "midline": (lambda: _lattice(0.5), "on its midline the mouth has"),
    "fan": (_fan, "beside the seam of its lips the face has"),
    "5,000 nodes of a mesh": (_changed(lambda d: d["nodes"].extend([{"mesh": 0}] * 4_999)), ""),
}


@needs_runtime
@pytest.mark.parametrize("name", AVATARS)
def test_avatars(tmp_path: Path, told: Told, stand_in: Path, name: str) -> None:  # noqa: F811
    """``labial fit`` and ``labial page --head`` say the same of each."""
    make, message = AVATARS[name]
    (tmp_path / "a.glb").write_bytes(glb(*make()))
    assert os.path.getsize("a.glb") <= LARGEST or name == "a million nodes"
    said = told("page", "f.csv", "--head", "a.glb", "--three", stand_in, "-o", "p.html")
    assert said.startswith("a.glb: " if message else "") and message in said, said
    if message:
        other = told("fit", "a.glb", "-o", "a.toml", "--no-figure")
        assert other == said or "unpack to" in other, other
        assert not os.path.exists("a.toml")


TEXTS: Dict[str, Tuple[bytes, str]] = {
    "nothing": (b"", "is not a whole .glb"),
    "deep JSON": (b"[" * 500_000, "its JSON is nested too deeply"),
    "deep objects": (b'{"nodes":' * 50_000, "its JSON is nested too deeply"),
    "a list": (b"[1]", "no glTF"),
    "not UTF-8": (b"{\xff}", "is not a whole .glb"),
    "a long number": (b'{"nodes":' + b"9" * 100_000 + b"}", "is not a whole .glb"),
    "a huge number": (b'{"nodes":[{"mesh":0,"scale":[1e999,1,1]}],"meshes":[{}]}', "has no mesh with shapes"),
    "values": (b"[" + b"[]," * 6_000_000 + b"[]]", "its JSON has 12,000,002 values, more than the 5,000,000 that are"),
    "nodes that are numbers": (b'{"nodes":[1,2]}', "nodes is not a list of objects"),
    "meshes that are text": (b'{"nodes":[],"meshes":"face"}', "meshes is not a list of objects"),
    "version 1": (struct.pack("<4sII", b"glTF", 1, 12), "version 1 of glTF is not read"),
    "a lying part": (struct.pack("<4sIII4s", b"glTF", 2, 20, 1 << 31, b"JSON"), "the file ends within a part"),
    "empty parts": (struct.pack("<4sII", b"glTF", 2, 12) + bytes(900_000), "is not a whole .glb"),
    "half a head": (b"glTF\x02", "is not a whole .glb"),
}


def test_buffers_beside_an_avatar(tmp_path: Path, told: Told) -> None:
    """A link that leaves the folder, a pipe that nobody writes, and one file many times; a link within is followed."""
    (tmp_path / "outside").mkdir()
    (tmp_path / "in").mkdir()
    document, binary = document_of(*made_head())
    (tmp_path / "outside" / "a.bin").write_bytes(binary)
    os.symlink("../outside/a.bin", "in/link.bin")
    os.symlink("a.bin", "in/near.bin")
    os.mkfifo("in/pipe")

    def of(uri: str) -> str:
        """The name of the avatar with its buffer there."""
        document["buffers"][0]["uri"] = uri
        (tmp_path / "in" / "a.gltf").write_text(json.dumps(document))
        return "in/a.gltf"

    for uri, message in (("link.bin", "lies outside the file's folder"), ("pipe", "buffer 0 is no file"),
                         ("none.bin", "buffer 0 is no file"), ("../in/../outside/a.bin", "outside the file's folder"),
                         ("a\0b", "is not a whole .glb")):
        assert message in told("fit", of(uri), "-o", "a.toml", "--no-figure")
    (tmp_path / "in" / "a.bin").write_bytes(binary)
    for uri in ("near.bin", "data:application/octet-stream;base64," + base64.b64encode(binary).decode()):
        assert "page takes a .glb" in told("page", "f.csv", "--head", of(uri), "-o", "p.html")
    with open("in/large.bin", "wb") as large:
        large.truncate(limits.AVATAR)
    assert "it and its buffers have 256,0" in told("fit", of("large.bin"), "-o", "a.toml", "--no-figure")


def test_names_of_shapes_stay_within_their_remark(tmp_path: Path, told: Told) -> None:
    """Would catch a name of a shape that becomes a line of the rig."""
    vertices, triangles, shapes = made_head()
    shapes = {name.replace("jawOpen", "x\n\"]\u2028.jawOpen"): move for name, move in shapes.items()}
    (tmp_path / "a\nunit = 3.glb").write_bytes(glb(*document_of(vertices, triangles, shapes)))
    assert told("fit", "a\nunit = 3.glb", "-o", "a.toml", "--no-figure") == ""
    text = (tmp_path / "a.toml").read_text()
    assert "[output.jawOpen]    # in the file: x\\n" in text and text.count("\nunit") == 1


# ---- Descriptions ----------------------------------------------------------------------------------------------------

DEEP = "a." * 2_000
TOMLS: Dict[str, Tuple[str, str]] = {
    "lists": ("a = " + "[" * 400_000, "not TOML: nested too deeply"),
    "tables": ("a = " + "{a=" * 200_000, "not TOML: nested too deeply"),
    "a key of many parts": (f"unit.{'a.' * 400_000}a = 1\n" + FACE, "nested too deeply"),
    "a name of many parts": (f"[output.jaw.{'a.' * 400_000}a]\n" + FACE, "nested too deeply"),
    "many keys of many parts": ("".join(f"unit.{DEEP}a{n} = 1\n" for n in range(240)) + FACE, "nested too deeply"),
    "a long number": ("unit = " + "9" * 900_000, "not TOML"),
    "a long text": (f'unit = "{"u" * 900_000}"\n' + FACE, "unit: '"),
    "a long key": ("u" * 900_000 + " = 1\n" + FACE, "unknown key"),
    "a long output": (f"[output.{'u' * 900_000}]\n" + FACE, "an output's name is"),
    "many outputs": ("".join(FACE.replace("jaw]", f"j{n}]") for n in range(16_000)), "it has 16,000 outputs"),
    "many keys": (FACE + "".join(f"k{n} = 1\n" for n in range(80_000)), "unknown key"),
    "a day": ("unit = 1979-05-27T07:32:00Z\n" + FACE, "unit: "),
    "too large": (FACE + "#" * 1_000_000, "it has 1,000,053 bytes, more than the 1,000,000 that are read"),
}


def test_corpora_say_who_speaks_in_toml(tmp_path: Path, told: Told) -> None:
    """The other file that is TOML."""
    folder = corpus(tmp_path / "c")
    (folder / "corpus.toml").write_text(f"talkers.{DEEP}a = 1\n")
    assert "c/corpus.toml:1: " in told("train", "c", "-o", "m.npz", "--jobs", 1)


# ---- Archives --------------------------------------------------------------------------------------------------------


def _zip(members: Mapping[str, Union[bytes, int]], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    """An archive of files with these contents, or of so many zeros."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", method) as archive:
        for name, content in members.items():
            if isinstance(content, bytes):
                archive.writestr(name, content)
                continue
            with archive.open(name, "w") as member:
                for _ in range(content // 1_000_000):
                    member.write(bytes(1_000_000))
    return made.getvalue()


def _npy(shape: str, kind: str = "<f4", content: bytes = b"") -> bytes:
    text = f"{{'descr': {kind!r}, 'fortran_order': False, 'shape': {shape}, }}".encode() + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text + content


def _lying(data: bytes, size: int, offset: int = 22, form: str = "<I") -> bytes:
    """The archive with another size of what it holds, unpacked, in every header; or with another number elsewhere."""
    for mark, place in ((b"PK\x03\x04", offset), (b"PK\x01\x02", offset + 2)):
        start = data.find(mark)
        while start >= 0:
            told = struct.pack(form, size)
            data = data[: start + place] + told + data[start + place + len(told) :]
            start = data.find(mark, start + 4)
    return data


def _model(name: str, content: bytes) -> Callable[[], bytes]:
    """A model in which another member has this content."""
    def made() -> bytes:
        save(random_model(1), "whole.npz")
        return archive({**members_of(Path("whole.npz")), name: content})

    return made


BOMBS: Dict[str, Tuple[Callable[[], bytes], str]] = {
    "zeros": (lambda: _zip({"model.json": 400_000_000}), "unpacked, it has 400,000,000 bytes, more than the"),
    "many of them": (lambda: _zip({f"{n}.npy": 5_000_000 for n in range(20)}), "unpacked, it has 100,000,000"),
    "a size that lies": (lambda: _lying(_zip({"model.json": 600_000_000}), 1_000), "is damaged"),
    "a size that is too large": (lambda: _lying(_zip({"model.json": b"{}"}), 10_000_000), "is damaged"),
    "bzip2": (lambda: _lying(_zip({"model.json": 300_000_000}, zipfile.ZIP_BZIP2), 1_000), "is packed by method 12"),
    "lzma": (lambda: _lying(_zip({"model.json": 90_000_000}, zipfile.ZIP_LZMA), 1_000), "is packed by method 14"),
    "many members": (lambda: _zip({f"{n}": b"" for n in range(9_000)}), "no model.json"),
    "deep JSON": (lambda: _zip({"model.json": b"[" * 900_000}), "model.json: not JSON"),
    "no zip": (lambda: b"PK\x03\x04" + bytes(900_000), "the zip file is damaged"),
    "two ends": (lambda: _zip({"a": b"b"}) + _zip({"model.json": b"{}"})[-22:], "model"),
    "encrypted": (lambda: _lying(_zip({"model.json": b"{}"}), 1, 6, "<H"), "is encrypted"),
    "a number": (_model("model.json", b"5"), "model.json: not an object"),
    "not UTF-8": (_model("model.json", b"\xff"), "model.json: not JSON"),
    "no format": (_model("model.json", b"{}"), "format None"),
    "a long number": (_model("model.json", b"9" * 5_000), "model.json: not"),
    "an empty array": (_model("kernel.npy", b""), "kernel is no array"),
    "complex numbers": (_model("kernel.npy", _npy("(1,)", "<c16", bytes(16))), "not real numbers"),
    "no dimension": (_model("kernel.npy", _npy("()", "<f8", bytes(8))), "kernel has shape ()"),
    "a large member": (_model("kernel.npy", bytes(80_000_000)), "more than the 1"),
    "no states": (_model("log_initial.npy", _npy("(13, 0)", "<f8")), "no states"),
    "negative counts": (_model("component_count.npy", _npy("(9,)", "<i8", b"\xff" * 72)), "component_count[0] is -1"),
}


@pytest.mark.parametrize(("array", "message"), [
    (_npy("(100, 478, 3)", "|O", bytes(1_000)), "has the type object"),
    (_npy("(1000000000, 478, 3)"), "has 0 bytes"), (_npy("(-1, 478, 3)"), "landmarks has the type"),
    (_npy("(" + "9" * 5_000 + ",)"), "landmarks"), (_npy("(" * 4_000), "landmarks is no array"),
    (_npy("-" * 9_000 + "1"), "landmarks"), (_npy("(1,) * 10**9"), "landmarks is no array"),
    (_npy("(0, 478, 3)"), "fewer than two frames"), (_npy("()", content=bytes(4)), "the shape ()"),
    (_npy("(2, 478, 3)", content=struct.pack("<f", float("nan")) * 2_868), "no frame has a face"),
    (_npy("(2, 478, 3)", content=struct.pack("<f", float("inf")) * 2_868), "a coordinate is beyond"),
    (_npy("(2, 478, 3)", "<M8[s]", bytes(8) * 2_868), "has the type"), (_npy("(2,)", "<f4", bytes(9)), "has 9 bytes"),
    (_npy("(16000000, 1, 1)", "|i1", bytes(16_000_000)), "landmarks have the shape"),
], ids=lambda given: repr(given[-24:]) if isinstance(given, bytes) else given[:12])
def test_arrays(tmp_path: Path, told: Told, array: bytes, message: str) -> None:
    """Headers that lie, objects, and numbers that are none."""
    pytest.importorskip("scipy")
    (tmp_path / "a.npz").write_bytes(_zip({"landmarks.npy": array}))
    said = told("record", "a.npz", "-o", "r", "--fps", 25)
    assert said.startswith("a.npz: ") and message in said, said
    (tmp_path / "b.npy").write_bytes(array)
    assert told("record", "b.npy", "-o", "r", "--fps", 25).startswith("b.npy: ")


@pytest.mark.parametrize(("members", "message"), [
    ({"a.csv": 160_000_000}, "c/x.zip: unpacked, it has 160,000,000 bytes"),
    ({"../a.csv": b"", "/etc/b.csv": b"", "b/c.csv": b""}, "no episodes"),
    ({"b.csv": b"\xff" * 9_000_000, "b.lab": b"0 1 SIL\n"}, "not UTF-8"),
    ({"b.csv": 9_000_000, "b.lab": b"0 1 SIL\n"}, "byte 0x00 is not text"),
    ({"b.csv": b"\n" * 16_000_000, "b.lab": b"0 1 SIL\n"}, "the header is not"),
    ({"b.csv": CSV_HEAD.encode() + b"\n" * 16_000_000, "b.lab": b"0 1 SIL\n"}, "no frames"),
    ({"b.csv": CSV_HEAD.encode() + (b"0" + 13 * b",0" + b"\n") * 570_000, "b.lab": b"0 1 SIL\n"}, "does not follow"),
    ({"b.csv": CSV_HEAD.encode() + b"".join(b"%d" % n + 13 * b",1" + b"\n" for n in range(86_400)),
      "b.lab": b"0 1 a" + b"a" * 9_000_000}, "c/x.zip/b.lab:1"),
    ({"n" * 60_000 + ".csv": b""}, "c/x.zip/nnnn"),
], ids=["bomb", "paths", "bytes", "zeros", "lines", "blank", "rows", "label", "name"])
def test_corpora_in_archives(tmp_path: Path, told: Told, members: Mapping[str, bytes], message: str) -> None:
    """Bombs; and files of an archive are read in memory, so that a path in it means nothing."""
    folder = corpus(tmp_path / "c")
    for item in folder.iterdir():
        item.unlink()
    (folder / "x.zip").write_bytes(_zip(members))
    assert os.path.getsize("c/x.zip") <= LARGEST
    said = told("train", "c", "-o", "m.npz", "--jobs", 1)
    assert said.startswith("c") and message in said, said


def test_corpora_of_links(tmp_path: Path, told: Told) -> None:
    """Links to a device, to itself and to a folder are no files of a corpus."""
    folder = corpus(tmp_path / "c")
    for number, target in enumerate(("/dev/zero", "l1.csv", "/", "none")):
        os.symlink(target, folder / f"l{number}.csv")
    os.mkfifo(folder / "pipe.lab")
    assert told("train", "c", "-o", "m.npz", "--jobs", 1) == "c: there is no phoneme of speech but silence"


# ---- Texts -----------------------------------------------------------------------------------------------------------

LINES: Dict[str, Tuple[str, bytes, str]] = {
    "deep JSON": ("a.json", b"[" * 900_000, "JSON that is nested too deeply"),
    "deep lines": ("a.json", (b"[" * 100_000 + b"\n") * 9, "nested too deeply"),
    "a long number": ("a.json", b'[{"phoneme":"a","start":0,"end":' + b"9" * 900_000 + b"}]", "a number of too many"),
    "numbers without end": ("a.json", b'[{"phoneme":"a","start":0,"end":1e999}]', "not a number from 0 on"),
    "NaN": ("a.json", b'[{"phoneme":"a","start":NaN,"end":1}]', "not a number from 0 on"),
    "a long label": ("a.lab", b"0 1 " + b"a" * 900_000, "a.lab:1"),
    "a long line": ("a.lab", b"0 " * 450_000, "a.lab:1"),
    "late": ("a.lab", b"0 1e300 a\n", "a.lab:1"),
    "zeros": ("a.lab", bytes(900_000), "byte 0x00 is not text"),
    "blank lines": ("a.lab", b"\n" * 900_000, "no segments"),
    "TextGrid": ("a.TextGrid", b'File type = "ooTextFile"\nObject class = "TextGrid"\n0\n1\n<exists>\n999999999\n',
                 "a.TextGrid"),
    "UTF-16": ("a.lab", b"\xff\xfe" + b"\x00\xd8" * 400_000, "not UTF-16 text"),
}


@pytest.mark.parametrize(("hours", "said"), [(1, False), (20, True)])
def test_motion_of_hours_is_told(tmp_path: Path, hours: int, said: bool) -> None:
    """A small file may ask for a day of motion: whoever waits for it is told why."""
    model = random_model(1)
    (tmp_path / "a.lab").write_text("".join(f"{3600 * n} {3600 * (n + 1)} SIL\n" for n in range(hours)))
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        read_stream(tmp_path / "a.lab", model)
    assert ["a.lab: its motion lasts 20.0 hours" in str(item.message) for item in found] == [True] * said


# ---- Sounds, and all files that one command reads alone --------------------------------------------------------------


def _wav(samples: int, rate: int = 16_000, channels: int = 1, data: Optional[int] = None, riff: Optional[int] = None,
         width: int = 2, kind: int = 1, content: bytes = b"") -> bytes:
    """A WAV file whose heads say what is wanted; its samples are 0, or `content`."""
    length = (samples or len(content)) if data is None else data
    whole = (36 + length if riff is None else riff) & 0xffffffff
    each = channels * width & 0xffff
    return (struct.pack("<4sI4s4sI", b"RIFF", whole, b"WAVE", b"fmt ", 16)
            + struct.pack("<HHIIHH", kind, channels, rate, min(rate * each, 2**32 - 1), each, 8 * width)
            + struct.pack("<4sI", b"data", length) + bytes(samples) + content)


SOUNDS: Dict[str, Tuple[Callable[[], bytes], str]] = {
    "2 GB of data": (lambda: _wav(32_000, data=(1 << 31) - 2), ""),
    "4 GB of data": (lambda: _wav(32_000, data=(1 << 32) - 2, riff=(1 << 32) - 1), ""),
    "1 Hz": (lambda: _wav(900_000, 1), "a rate of 1 "),
    "4 GHz": (lambda: _wav(900_000, 2_000_000_000), "a rate of 2,000,000,000 "),
    "no rate": (lambda: _wav(900_000, 0), ""),
    "65,535 channels": (lambda: _wav(900_000, 16_000, 65_535), ""),
    "no channels": (lambda: _wav(900_000, 16_000, 0), ""),
    "hours of 8 bits": (lambda: _wav(999_000, 1_000, 1, width=1), ""),
    "nothing": (lambda: _wav(0), ""),
    "no head": (lambda: b"RIFF" + bytes(900_000), "not a sound that can be read"),
    "loud floats": (lambda: _wav(0, width=4, kind=3, content=struct.pack("<f", 3e38) * 200_000), "a sample is "),
    "parts without end": (lambda: _wav(0, content=bytes(8) * 110_000), ""),
}


#: Of each file the commands that read it, and by what it is what the first of them says; of what it says nothing about
#: it only has to end.
FILES: List[Tuple[str, List[List[str]], Mapping[str, Tuple[Any, str]]]] = [
    ("a.gltf", [["fit", "a.gltf", "-o", "a.toml", "--no-figure"]], TEXTS),
    ("face.toml", [["rig", "face.toml", "-o", "o", "--no-figure"]], TOMLS),
    ("m.npz", [["export", "m.npz", "--name", "m", "-o", "o"], ["evaluate-hear", "m.npz", "-o", "t"],
               ["record", "m.npz", "-o", "r"], ["synth", "m.npz", "f.csv"]], BOMBS),
    *((file, [["timings", file]], {what: (content, message)}) for what, (file, content, message) in LINES.items()),
    ("a.wav", [["hear", "a.wav", "--sound-alone", "--model", "small", "-o", "h.csv"]], SOUNDS),
]


@pytest.mark.parametrize(("file", "commands", "content", "message"), [
    pytest.param(file, commands, *row, id=f"{file}: {what}")
    for file, commands, rows in FILES for what, row in rows.items()])
def test_files(tmp_path: Path, told: Told, file: str, commands: List[List[str]], content: Any, message: str) -> None:
    """What is in the way of an avatar before its meshes are; descriptions, archives, all formats of timings, sounds."""
    data = content() if callable(content) else content
    (tmp_path / file).write_bytes(data.encode() if isinstance(data, str) else data)
    assert file != "m.npz" or len(data) <= LARGEST
    for command, part in zip(commands, [message, *[""] * 9]):
        said = told(*command)
        assert said.startswith(f"{file}:" if message else "") and part in said, (command, said)


def test_sounds_that_last_for_days(tmp_path: Path, told: Told) -> None:
    """Compressed silence: hours in some kilobytes."""
    soundfile = pytest.importorskip("soundfile")
    with soundfile.SoundFile(tmp_path / "a.flac", "w", 8_000, 1, "PCM_16") as out:
        for _ in range(60):
            out.write(np.zeros(8_000 * 600, np.int16))
    assert os.path.getsize("a.flac") <= LARGEST
    said = told("align", "a.flac", "--text", "a")
    assert said.startswith("a.flac: it lasts at least ") and said.endswith(" that are read"), said


# ---- Texts -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["9" * 90_000, "1:2:3:" * 15_000, "hello " * 15_000], ids=["digits", "times", "words"])
def test_long_texts(told: Told, text: str) -> None:
    """A synthesiser would need minutes and gigabytes for them; without one they are timed."""
    said = told("say", text, "--voice", "flite:slt", "-o", "a.html")
    assert said.startswith("the text has 90,000 characters, more than the 1,000 that a voice says at once"), said
    assert not told("say", text, "--voice", "none", "-o", "a.lab")


@needs_runtime
def test_long_texts_of_a_recording(tmp_path: Path, told: Told) -> None:
    """Nobody speaks them: they are the page's title."""
    (tmp_path / "a.wav").write_bytes(_wav(64_000))
    assert not told("say", "hello " * 15_000, "--audio", "a.wav", "-o", "a.html")


# ---- Binary models ---------------------------------------------------------------------------------------------------


@needs_runtime
@pytest.mark.parametrize(("content", "message"), [
    (b"", "a.lbm: "), (bytes(900_000), "a.lbm: "), (b"LBL" * 300_000, "a.lbm: "), (None, "more than the 64,000,000"),
], ids=["nothing", "zeros", "letters", "large"])
def test_binary_models(tmp_path: Path, told: Told, content: Optional[bytes], message: str) -> None:
    """``labial.Model``, for programs in Python."""
    from labial.errors import ModelError
    from labial.runtime.models import Model

    if content is not None:
        Path("a.lbm").write_bytes(content)
    else:
        os.symlink("/dev/zero", "a.lbm")
    with pytest.raises(ModelError, match=message):
        Model("a.lbm")


# ---- Anything --------------------------------------------------------------------------------------------------------


TEXT_GRID = ''.join(f"{line}\n" for line in (
    'File type = "ooTextFile"', 'Object class = "TextGrid"', "", "xmin = 0", "xmax = 1", "tiers? <exists>", "size = 1",
    "item []:", "    item [1]:", '        class = "IntervalTier"', '        name = "phones"', "        xmin = 0",
    "        xmax = 1", "        intervals: size = 1", "        intervals [1]:", "            xmin = 0",
    "            xmax = 1", '            text = "AA1"'))


def _given(folder: Path) -> Dict[str, List[List[str]]]:
    """Small valid files of each kind, and commands that read each."""
    vertices, triangles, shapes = made_head()
    few = {name: shapes[name] for name in ("jawOpen", "mouthClose", "mouthPucker", "mouthSmileLeft")}
    document, binary = document_of(vertices, triangles, few, sparse=True)
    (folder / "a.glb").write_bytes(glb(document, binary))
    document["buffers"][0]["uri"] = "data:;base64," + base64.b64encode(binary).decode()
    (folder / "a.gltf").write_text(json.dumps(document))
    (folder / "a.toml").write_text(FACE)
    save(random_model(1), folder / "a.npz")
    (folder / "a.lab").write_text(LAB)
    (folder / "a.json").write_text(json.dumps([{"phoneme": "a", "start": 0, "end": 0.2}]))
    (folder / "a.TextGrid").write_text(TEXT_GRID)
    (folder / "a.fap").write_text("2.1 x 25 2\n" + "".join(" ".join(["0", "0", "1"] + 65 * ["0"]) + f"\n{n} 7\n"
                                                           for n in range(2)))
    write_motion(folder / "a.csv", np.arange(9) / 50, np.zeros((9, 13)))
    np.savez(folder / "seen.npz", landmarks=turned(talking()[0]).astype(np.float32), fps=50.0)
    (folder / "seen.lab").write_text(TALK)
    rng = np.random.default_rng(1)
    noise = rng.integers(-9000, 9000, 2_000).astype("<i2").tobytes()
    (folder / "a.wav").write_bytes(_wav(0, data=len(noise)) + noise)
    return {"a.glb": [["page", "f.csv", "--head", "a.glb", "--three", "three", "-o", "o.html"]],
            "a.gltf": [["page", "f.csv", "--head", "a.gltf", "--three", "three", "-o", "o.html"]],
            "a.toml": [["rig", "a.toml", "-o", "o", "--no-figure"], ["bake", "f.csv", "--rig", "a.toml", "-o", "o.h"]],
            "a.npz": [["synth", "a.npz", "no.lab", "-o", "o.csv"], ["export", "a.npz", "--name", "m", "-o", "o"]],
            "a.lab": [["timings", "a.lab", "-o", "o.lab"], ["synth", "a.npz", "a.lab", "-o", "o.csv"],
                      ["bake", "a.lab", "--as", "phonemes", "-o", "o.h", "--model", "a.npz"],
                      ["page", "f.csv", "--phones", "a.lab", "-o", "o.html"]],
            "a.json": [["timings", "a.json", "-o", "o.lab"]],
            "a.TextGrid": [["timings", "a.TextGrid", "-o", "o.lab"]],
            "a.fap": [["page", "a.fap", "-o", "o.html"]],
            "a.csv": [["bake", "a.csv", "-o", "o.h"], ["page", "a.csv", "-o", "o.html"],
                      ["plot", "a.csv", "-o", "o.png"]],
            "seen.npz": [["record", "seen.npz", "-o", "r"]], "seen.lab": [["record", "seen.npz", "-o", "r"]],
            "a.wav": [["hear", "a.wav", "--sound-alone", "-o", "o.csv"]]}


def _mutated(data: bytes, chance: random.Random) -> bytes:
    """Parts changed as test_timings.py does it, or four bytes that lengths and counts rarely are."""
    if chance.random() < 0.7:
        return damaged(data, chance)
    place = chance.randrange(len(data) + 1)
    return data[:place] + chance.choice((b"\xff" * 4, bytes(4), b"\x7f\xff\xff\xff", b"\0\0\0\x80")) + data[place + 4:]


#: Seconds for each kind of file.
FUZZED = 2.0 if "LABIAL_REQUIRE_ALL" in os.environ else 0.6


@needs_runtime
@pytest.mark.parametrize("name", ["a.glb", "a.gltf", "a.toml", "a.npz", "a.lab", "a.json", "a.TextGrid", "a.fap",
                                  "a.csv", "seen.npz", "seen.lab", "a.wav"])
def test_fuzzed_files(tmp_path: Path, told: Told, stand_in: Path, name: str) -> None:  # noqa: F811
    """Would catch a traceback, a hang, memory without bound, two lines; and a bit of an archive that nobody misses."""
    pytest.importorskip("scipy")
    signal.setitimer(signal.ITIMER_PROF, FUZZED + SECONDS)
    commands = _given(tmp_path)[name]
    data, chance = (tmp_path / name).read_bytes(), random.Random(name)
    for command in commands:
        assert "no.lab" in command or not told(*command) or name == "a.gltf", "what is not changed is read"
    end = time.process_time() + FUZZED
    refused: List[bool] = []
    while time.process_time() < end:
        (tmp_path / name).write_bytes(_mutated(data, chance))
        for folder in ("o", "r"):
            shutil.rmtree(tmp_path / folder, ignore_errors=True)
        refused.append(told(*chance.choice(commands)).startswith(name))
    assert sum(refused) > (len(refused) / 2 if name.endswith(".npz") else 0)
