"""The npm packages: bytes of the module, of what a browser fetches, of the packed packages; microseconds per frame."""

from __future__ import annotations

import gzip
import json
from pathlib import Path

from measure.core import Bench, run, tool, version


def measure(bench: Bench) -> None:
    """Builds the package and measures it under node. Compressed bytes are those of gzip at its highest level."""
    what = "The npm package"
    for name, package in (("clang", "clang"), ("wasm-ld", "lld"), ("node", "nodejs"), ("npm", "npm")):
        tool(name, package, what)
    folder = bench.build / "wasm"
    toolchain = bench.source / "boards" / "toolchains" / "wasm.cmake"
    run(["cmake", "-S", bench.source, "-B", folder, f"-DCMAKE_TOOLCHAIN_FILE={toolchain}", "-DCMAKE_BUILD_TYPE=Release",
         "-DLABIAL_BUILD_EXAMPLES=OFF", "-DLABIAL_BUILD_TESTS=OFF"])
    run(["cmake", "--build", folder, "--target", "npm-pack", "--parallel", "2"])
    compiler = version("clang")
    module = folder / "packaging" / "npm" / "labial.wasm"
    names = ("index.js", "memory.js", "speech.js", "stream.js", "timings.js", "track.js", "unpack.js")
    scripts = [folder / "npm" / name for name in names]
    laughter = folder / "npm-laughter" / "index.js"
    bench.add("wasm", "module with speech", module.stat().st_size, "bytes", ["ls", "-l", module], compiler)
    bench.add("wasm", "a page that speaks, each script compressed", sum(map(_compressed, scripts)), "bytes",
              ["gzip", "-9c", folder / "npm" / "*.js", "|", "wc", "-c", "#", *names], compiler)
    bench.add("wasm", "laughter, compressed", _compressed(laughter), "bytes",
              ["gzip", "-9c", laughter, "|", "wc", "-c"], compiler)
    for packed in sorted(folder.glob("labial-*.tgz")):
        name = "packed laughter package" if "laughter" in packed.name else "packed package"
        bench.add("wasm", name, packed.stat().st_size, "bytes", ["ls", "-l", packed], compiler)
    command = ["node", bench.source / "bench" / "npm.mjs", folder / "npm"]
    engine = "node " + run(["node", "--version"]).stdout.decode().strip().lstrip("v")
    for way, value in json.loads(run(command).stdout).items():
        bench.add("wasm", f"speech: {way}", value, "us/frame", command, f"{engine}, {compiler}")


def _compressed(path: Path) -> int:
    return len(gzip.compress(path.read_bytes(), 9, mtime=0))
