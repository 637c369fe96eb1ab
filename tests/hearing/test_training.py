"""labial train-hear with PyTorch itself: the network is that of the library, and a short training learns."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import List, Tuple

import numpy as np
import pytest
import soundfile
import torch

from labial.__main__ import main
from labial.errors import LabialError
from labial.hearing import features, network, prepared, quantise, targets, train
from labial.hearing.model import CLASSES, PLANS, HearingModel, Memory, load
from labial.hearing.prepared import Prepared
from labial.hearing.targets import Closure
from labial.hearing.train import Learner, Remembered, model_of, restore, rounded

NO_CLOSURE = Closure(np.zeros(13, np.float32), np.zeros(13, np.float32))
#: Files with a name of its own each, of which some are held out (labial.hearing.prepared.is_held).
NAMES = [f"{k}" for k in range(30)]


def made(learner: Learner) -> HearingModel:
    return model_of(learner, np.full(13, 5.0), np.full(13, 50.0), NO_CLOSURE, (-1.0, 1.0), "", {})


@pytest.mark.parametrize("reach", [Memory(4, 1, 2), Memory(0, 2, 1), Memory(3, 0, 3)])
def test_a_memory_has_the_right_gradient(reach: Memory) -> None:
    """Against differences of its values."""
    torch.manual_seed(0)
    y = torch.randn(2, 11, 3, dtype=torch.double, requires_grad=True)
    weight = torch.randn(3, reach.taps, dtype=torch.double, requires_grad=True)
    assert torch.autograd.gradcheck(lambda one, two: Remembered.apply(one, two, reach), (y, weight))


@pytest.mark.parametrize("name", sorted(PLANS))
def test_what_is_trained_is_what_hears(name: str) -> None:
    """The learner with rounded weights against the float network of its model, in scores and frames."""
    torch.manual_seed(1)
    learner = Learner(PLANS[name])
    heard = np.random.default_rng(0).uniform(-2.25, 2.75, (60, 48)).astype(np.float32)
    found = network.run(made(learner), heard)
    with torch.no_grad():
        scores, closed, faps, excess = learner(torch.from_numpy(heard)[None], True)
    assert np.abs(found.closed - closed[0].numpy()).max() < 1e-4
    assert np.abs(found.scores - scores[0].numpy()).max() < 1e-4
    assert np.abs(found.faps - (5.0 + 50.0 * faps[0].numpy())).max() < 5e-3 and float(excess) >= 0


def test_a_model_can_be_the_beginning(tmp_path: Path) -> None:
    """Its weights for frames of any mean and scale, after no step that changes much; a larger network, and one that
    looks further ahead, begin with what it hears; a smaller one is refused."""
    torch.manual_seed(2)
    first = made(Learner(PLANS["small"]))
    learner, heard = Learner(PLANS["small"]), np.random.default_rng(0).uniform(-2, 2, (40, 48)).astype(np.float32)
    mean, scale = np.linspace(-20, 20, 13), np.linspace(10, 90, 13)
    restore(learner, first, mean, scale)
    again = network.run(model_of(learner, mean, scale, NO_CLOSURE, (-1.0, 1.0), "", {}), heard)
    found = network.run(first, heard)
    assert np.abs(again.scores - found.scores).max() < 1e-4
    assert np.abs(again.faps - found.faps).max() < 0.02 * np.abs(found.faps).max()  # the heads are rounded anew
    with pytest.raises(LabialError, match="76 units in 4 blocks cannot begin with a model of 68 units in 3 blocks"):
        train.train([folder(0)], train.Options("large", 1), str(tmp_path / "a"), start=first)
    large, ahead = Learner(PLANS["large"]), Learner(PLANS["ahead"])
    restore(ahead, made(large), np.full(13, 5.0), np.full(13, 50.0))
    given = torch.from_numpy(heard)[None]
    with torch.no_grad():
        for one, two in zip(large(given, True)[:3], ahead(given, True)[:3]):
            assert float((one - two).abs().max()) < 1e-4
    with pytest.raises(LabialError, match="a network of 76 units in 4 blocks cannot begin with a model of 192 units"):
        restore(large, made(ahead), np.zeros(13), np.ones(13))
    steps = [train.train([folder(0)], train.Options("small", 1, rate), str(tmp_path / f"{rate}"), start=first)
             for rate in (1e-9, 1e-2)]
    apart = [np.abs(model.bias[1] - first.bias[1]).max() for model in steps]
    assert apart[0] < 1e-6 < apart[1]


def test_weights_are_rounded_as_the_library_rounds_them() -> None:
    """Against labial.hearing.quantise, and with the gradient of the weight itself."""
    weight = torch.randn(20, 30, requires_grad=True)
    with torch.no_grad():
        weight *= torch.logspace(-5, 1, 20)[:, None]
    found = rounded(weight)
    assert found.detach().numpy() == pytest.approx(quantise.rounded(weight.detach().numpy()), abs=1e-9)
    assert torch.autograd.grad(found.sum(), weight)[0].eq(1).all()


def folder(seed: int, count: int = 24) -> Prepared:
    """Takes in which the energy of the high bands tells one of two classes and poses."""
    random = np.random.default_rng(seed)
    classes = np.repeat(random.integers(0, 2, size=60 * count), 8)
    energies = random.normal(12, 1, (2 * len(classes), features.BANDS))
    energies[:, 16:] += 8 * np.repeat(classes, 2)[:, None]
    frames = np.where(classes[:, None] == CLASSES.index("M"), -60, 40) + np.zeros(13)
    lengths = np.full(count, len(classes) // count)
    return Prepared(energies.astype(np.float16), frames.astype(np.int16), classes.astype(np.uint8), lengths,
                    np.arange(count) % 6 == 0)


def test_it_learns_and_is_resumed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Most classes are right after few steps. A training that stops and goes on gives the same model as one that does
    not, and writes the unfinished one; other options and other files are refused."""
    monkeypatch.setattr(train, "CHECKPOINT", 15)
    monkeypatch.setattr(train, "REPORT", 5)
    monkeypatch.setattr(train, "_WARM", 5)
    given, asked = [folder(0), folder(1)], train.Options("small", 40, shares=(2.0, 1.0), attribution="Mine.")
    told: List[str] = []
    whole = train.train(given, asked, str(tmp_path / "a"), told.append, tmp_path / "early.npz")
    right = float(told[-2].partition("classes ")[2].partition(",")[0])
    assert right > 0.85 and told[-1].startswith("held out") and load(tmp_path / "early.npz").training["step"] == 30
    assert whole.attribution == "Mine." and whole.training["steps"] == 40
    stopped = tmp_path / "b"

    def stop(line: str) -> None:
        if line.startswith("step 35"):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        train.train(given, asked, str(stopped), stop)
    again = train.train(given, asked, str(stopped))
    assert all(np.array_equal(one, two) for one, two in zip(whole.dense, again.dense))
    assert np.array_equal(whole.fap_weight, again.fap_weight) and whole.close_from == again.close_from
    with pytest.raises(LabialError, match="a checkpoint of other options"):
        train.train(given, train.Options("small", 41, shares=(2.0, 1.0)), str(stopped))
    stopped.write_bytes(b"none")
    with pytest.raises(LabialError, match="not a checkpoint of train-hear"):
        train.train(given, asked, str(stopped))


def test_a_teacher_is_heard() -> None:
    """By hand: the teacher's share of frames, classes and closures; of sounds without a text only what it hears."""
    torch.manual_seed(3)
    teacher, part = made(Learner(PLANS["small"])), folder(2, 4)
    own, both, alone = (prepared.lesson(part, *given) for given in ((), (teacher, 0.25), (teacher, 1.0)))
    energies = part.energies[: 2 * part.lengths[0]].astype(np.float32)
    heard = network.run(teacher, features.normalise(energies).reshape(part.lengths[0], -1))
    first = slice(0, part.lengths[0])
    assert np.abs(alone.frames[first] - heard.faps).max() <= 0.51
    assert np.abs(both.frames[first] - (0.75 * part.frames[first] + 0.25 * heard.faps)).max() <= 0.51
    assert np.abs(alone.closed[first] - 1 / (1 + np.exp(-heard.closed))).max() < 1e-2
    assert np.abs(both.likely - (0.75 * own.likely + 0.25 * alone.likely)).max() < 1e-2
    assert (own.classes == part.classes).all() and (both.classes == part.classes).all()
    assert (alone.classes[first] == heard.scores.argmax(axis=1)).mean() > 0.99
    closed = (own.closed == 1) == ((part.classes == 1) & (targets.opening(part.frames) <= targets.TOUCHING))
    assert closed.all() and own.weight[part.classes == 1].min() == 4


def test_it_learns_from_a_teacher(tmp_path: Path) -> None:
    """Takes without a truth alone make another network of it; nothing is chosen on them."""
    torch.manual_seed(4)
    teacher = made(Learner(PLANS["small"]))
    asked = train.Options("small", 3, shares=(1.0, 1.0), taught=0.5)
    found = [train.train([folder(0)], asked, str(tmp_path / f"{k}"), sounds=[folder(k)], teacher=teacher)
             for k in (1, 2)]
    assert np.abs(found[0].last - found[1].last).max() > 0


@pytest.mark.parametrize(("shares", "count", "message"), [
    ((1.0,), 24, "1 shares are given for 2 folders"), ((1.0, -1.0), 24, "shares are given"),
    ((), 0, "folder 2 has no more than 200 frames"),
])  # fmt: skip
def test_what_cannot_be_learned(shares: Tuple[float, ...], count: int, message: str, tmp_path: Path) -> None:
    """Shares of other folders, and a folder with next to nothing."""
    second = folder(1) if count else folder(1, 24).part(True)
    if not count:
        second = Prepared(second.energies[:200], second.frames[:100], second.classes[:100], np.array([100]),
                          np.array([False]))
    with pytest.raises(LabialError, match=message):
        train.train([folder(0), second], train.Options("small", 1, shares=shares), str(tmp_path / "a"))


def speech(place: Path) -> Path:
    """Files in which a buzz is a vowel and a hum through closed lips an M, with their timings."""
    place.mkdir()
    time = np.arange(16000) / 16000
    for name in NAMES:
        hum = 0.1 * np.sin(2 * np.pi * 200 * time)
        buzz = 0.3 * np.sign(np.sin(2 * np.pi * 150 * time))
        sound = np.where((time > 0.4) & (time < 0.55), hum, buzz) * ((time > 0.1) & (time < 0.9))
        soundfile.write(str(place / f"{name}.flac"), sound, 16000)
        (place / f"{name}.lab").write_text("0 .1 SIL\n.1 .4 AA\n.4 .55 M\n.55 .9 AA\n.9 1 SIL\n")
    return place


def test_the_command_trains(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """From sounds to a model that the library can hold; the same again from the cache; and wrong options are named."""
    given = ["train-hear", str(speech(tmp_path / "in")), "--steps", "30", "--takes", "2", "--attribution", "Me.",
             "--cache", str(tmp_path / "cache")]
    for name in ("a.npz", "b.npz"):
        assert main([*given, "-o", str(tmp_path / name)]) == 0
    told = capsys.readouterr()
    assert "step 30 of 30" in told.err and "a.npz: small, 30 steps; held out: opening" in told.out
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    assert not list(tmp_path.glob("*.checkpoint"))
    model = load(tmp_path / "a.npz")
    assert model.attribution == "Me." and model.plan == PLANS["small"]
    assert quantise.quantise(model, "hear").units == PLANS["small"].units
    for options, message in ((["--shares", "1,2"], "--shares: 2 numbers for 1 folders"),
                             (["--takes", "0"], "--takes: a sound is prepared 1 to 100 times"),
                             (["--shares", "x"], "--shares: 'x' is not a number"),
                             (["--smoothness", "-1"], "--smoothness -1 is not within 0 .. 1000"),
                             (["--rate", "0"], "--rate 0 is not within 0 .. 1"),
                             (["--model", "large", "--start", str(tmp_path / "a.npz")], "cannot begin with a model of"),
                             (["--taught", "2"], "--taught 2 is not within 0 .. 1"),
                             (["--sounds", str(tmp_path)], "--sounds needs a --teacher")):
        assert main([*given, "-o", str(tmp_path / "c.npz"), *options]) == 1
        assert message in capsys.readouterr().err
    (tmp_path / "in" / "3.lab").write_text("0 1 XYZ\n")
    assert main([*given, "-o", str(tmp_path / "c.npz")]) == 1
    assert "3.lab:1: no speech phoneme is called 'XYZ'" in capsys.readouterr().err
    shutil.rmtree(tmp_path / "in")
    assert main([*given, "-o", str(tmp_path / "c.npz")]) == 1 and "not a folder" in capsys.readouterr().err


def test_commands_say_what_they_need(monkeypatch: pytest.MonkeyPatch, tmp_path: Path,
                                     capsys: pytest.CaptureFixture) -> None:
    """Without PyTorch."""
    monkeypatch.setitem(sys.modules, "torch", None)
    assert main(["train-hear", str(tmp_path), "-o", str(tmp_path / "a.npz")]) == 1
    assert "training needs the package torch: pip install '.[hear]'" in capsys.readouterr().err
