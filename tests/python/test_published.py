"""The published method unit by unit: its parts, and the whole against other programs and dense algebra; on a device, in
models of ``--method paper``, with its open choices made otherwise, and with what Labial changes."""

from __future__ import annotations

import io
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import List

import numpy as np
import pytest
from hmmlearn.hmm import GaussianHMM

from labial.__main__ import main
from labial.bake.source import Source, read_track
from labial.corpus.folder import read_frames
from labial.corpus.phonesets import PHONE_SETS, SPEECH
from labial.evaluate import choices, departures, methods
from labial.evaluate.choices import CHOICES, Choice
from labial.evaluate.departures import DEPARTURES
from labial.evaluate.material import utterances
from labial.evaluate.training import Training
from labial.reference import published
from labial.reference import stream as steps
from labial.reference.fade import delivered
from labial.reference.published import OVERLAP, PIECE_MAX, Piece, join, pieces, synthesise, viterbi, whole_piece
from labial.reference.tables import Equation, ExportedTables, FloatTables
from labial.reference.units import frame_counts
from labial.rig.animation import FORMATS, with_shares
from labial.see import motion
from labial.tables.model import load, save
from labial.tables.phones import read_stream
from labial.tables.quantise import quantise
from labial.train import codebook, pipeline, shapes
from models import random_model, streams, write_episode
from test_evaluate import law, planted
from test_trajectory import dense
from test_viterbi import hidden_markov_model, likeliest


def unit_by_other_means(tables: FloatTables, target: np.ndarray, channel: int) -> np.ndarray:
    """(T,) one channel of a unit: hmmlearn's path for its targets (T, 13), and the dense solution of equation 3."""
    model = tables.model
    hidden = GaussianHMM(model.emission_mean.shape[1], covariance_type="diag")
    hidden.n_features = 1
    hidden.startprob_ = np.exp(model.log_initial[channel])
    hidden.transmat_ = np.exp(model.log_transition[channel])
    hidden.means_, hidden.covars_ = model.emission_mean[channel][:, None], model.emission_variance[channel][:, None]
    path = hidden.decode(target[:, channel : channel + 1])[1]
    states = model.state_precision[channel, path][:, None], model.state_mean[channel, path][:, None]
    anchor, aim = model.state_anchor[channel, path][:, None], target[:, channel : channel + 1]
    return dense(Equation(*states, anchor, aim), 0)


def test_the_whole_method_by_other_programs() -> None:
    """V-CC-V-C-V: two units that share a vowel of five frames. Each phoneme holds the mean of its likeliest component,
    each unit is hmmlearn's path and equation 3's matrix written out, and the shared vowel passes over in even steps."""
    model = random_model(4, "paper")
    tables = FloatTables(model)
    stream = [(1, 80), (2, 60), (3, 100), (4, 100), (5, 60), (7, 80)]  # 1, 4 and 7 are boundaries
    shapes = []
    for phoneme, milliseconds in stream:
        own = slice(3 * phoneme, 3 * phoneme + 3)
        z = (milliseconds / 1000 - model.duration_mean[own]) ** 2 / model.duration_variance[own]
        score = model.log_weight[own] - 0.5 * (z + np.log(model.duration_variance[own]))
        shapes.append(model.shape[own][int(score.argmax())])
    target = np.repeat(shapes, [4, 3, 5, 5, 3, 4], axis=0)
    found = synthesise(tables, stream)
    assert found.shape == (24, 13)
    for k in range(13):
        first, second = unit_by_other_means(tables, target[:17], k), unit_by_other_means(tables, target[12:], k)
        share = np.arange(1, 6) / 6
        expected = [first[:12], first[12:] + (second[:5] - first[12:]) * share, second[5:]]
        np.testing.assert_allclose(found[:, k], np.concatenate(expected), atol=1e-8)
        whole = synthesise(tables, stream, whole=True)[:, k]
        np.testing.assert_allclose(whole, unit_by_other_means(tables, target, k), atol=1e-8)


@pytest.mark.parametrize(("counts", "boundary", "least", "expected"), [
    # V-C-V: each vowel belongs to the unit that it ends and to the one that it begins; V-CC-V is one unit.
    ([4, 9, 5, 2, 6], [1, 0, 1, 0, 1], 0, [Piece(0, 18, 0, 5), Piece(13, 26, 5, 0)]),
    ([4, 3, 3, 5], [1, 0, 0, 1], 0, [Piece(0, 15, 0, 0)]),
    ([4, 3, 4, 3, 4], [1, 0, 1, 0, 1], 0, [Piece(0, 11, 0, 4), Piece(7, 18, 4, 0)]),
    # Where seams are measured, a piece ends with the first unit that gives it so many frames, if that fits.
    ([4, 3, 4, 3, 4, 3, 5, 20], [1, 0] * 4, 16, [Piece(0, 18, 0, 4), Piece(14, 46, 4, 0)]),
    ([4, 3, 4, 35, 5], [1, 0, 1, 0, 1], 16, [Piece(0, 11, 0, 4), Piece(7, 47, 4, 8), Piece(39, 51, 8, 0)]),
    # A stream's first and last phoneme are boundaries; long units are cut and chained; no frames are no piece.
    ([4, 3, 3], [0, 0, 0], 0, [Piece(0, 10, 0, 0)]),
    ([100], [0], 0, [Piece(0, 40, 0, 8), Piece(32, 72, 8, 8), Piece(64, 100, 8, 0)]),
    ([2, 30, 4, 5], [0, 1, 0, 1], 0, [Piece(0, 32, 0, OVERLAP), Piece(24, 41, OVERLAP, 0)]),
    ([4, 0, 3, 0], [0, 1, 0, 1], 0, [Piece(0, 7, 0, 0)]),
    ([0, 0], [1, 1], 0, []),
])
def test_units_run_from_boundary_to_boundary_inclusive(counts: List[int], boundary: List[int], least: int,
                                                       expected: List[Piece]) -> None:
    assert pieces(counts, list(map(bool, boundary)), *[least] * bool(least)) == expected


def test_edges() -> None:
    """No frames are no piece; a stream may end before it began."""
    assert whole_piece([0]) == [] and whole_piece([3, 0, 4]) == [Piece(0, 7, 0, 0)]
    assert synthesise(FloatTables(random_model(1, "paper")), [(1, 9)]).shape == (0, 13)


@pytest.mark.parametrize("seed", range(8))
def test_pieces_cover_every_frame_once_or_twice(seed: int) -> None:
    """For any stream: no gap, no frame in three pieces, no piece that is too long, shared frames agree."""
    model = random_model(seed)
    for stream in streams(len(model.phonemes), model.boundary, seed).values():
        counts = frame_counts([ms for _, ms in stream], 50)
        cut = pieces(counts, [bool(model.boundary[p]) for p, _ in stream])
        cover = np.zeros(sum(counts), dtype=int)
        for before, after in zip([None, *cut], cut):
            cover[after.begin : after.end] += 1
            assert 0 < after.end - after.begin <= PIECE_MAX
            assert after.fade_in + after.fade_out <= after.end - after.begin
            assert after.fade_in == (before.end - after.begin if before else 0)
            assert after.fade_in == (before.fade_out if before else 0) <= OVERLAP
        assert cover.size == 0 or (cover.min() >= 1 and cover.max() <= 2)


def test_search_by_every_path_of_small_cases() -> None:
    """Catches transitions read [to, from], a forgotten start or last frame, channels that mix."""
    rng = np.random.default_rng(0)
    for frames, states in ((1, 3), (2, 4), (5, 3)):
        transition = -np.log(rng.dirichlet(np.ones(states), (4, states)))
        emission, initial = rng.exponential(2.0, (frames, 4, states)), rng.exponential(1.0, (4, states))
        transition[rng.random(transition.shape) < 0.3] = np.inf
        transition[:, np.arange(states), np.arange(states)] = 1.0
        path = viterbi(emission, transition, initial)
        for k in range(4):
            assert tuple(path[:, k]) == likeliest(emission[:, k], transition[k], initial[k])


def test_search_agrees_with_hmmlearn() -> None:
    """hmmlearn's search is another program."""
    model = hidden_markov_model(1, 12, 0.3)
    x, _ = model.sample(200, random_state=2)
    likelihood, expected = model.decode(x)
    variance = model.covars_[:, 0, 0]
    emission = 0.5 * ((x - model.means_[:, 0]) ** 2 / variance + np.log(2 * np.pi * variance))
    with np.errstate(divide="ignore"):
        transition, initial = -np.log(model.transmat_), -np.log(model.startprob_)
    path = viterbi(emission, transition, initial)
    np.testing.assert_array_equal(path, expected)
    np.testing.assert_allclose(-published.path_cost(path, emission, transition, initial), likelihood)


def test_ties_and_edges() -> None:
    """Equal paths must not depend on the platform; the middle frame of a stride is looked at; no frames are no path."""
    assert not viterbi(np.zeros((6, 2, 3)), np.zeros((2, 3, 3)), np.zeros((2, 3))).any()
    assert viterbi(np.zeros((0, 2, 3)), np.zeros((2, 3, 3)), np.zeros((2, 3))).shape == (0, 2)
    assert published.looked_at(7, 3).tolist() == [1, 4, 6] and published.looked_at(4, 2).tolist() == [1, 3]


# ---- The published method on a device --------------------------------------------------------------------------------


HERE = Path(__file__).resolve().parent
LAB = "0 0.2 SIL\n0.2 0.3 P1\n0.3 0.42 P2\n0.42 0.5 P3\n0.5 0.9 P4\n0.9 1.3 P1\n1.3 1.8 SIL\n"


@pytest.fixture
def given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    save(random_model(1, "paper"), tmp_path / "paper.npz")
    save(random_model(1), tmp_path / "labial.npz")
    (tmp_path / "phones.lab").write_text(LAB)
    return tmp_path


needs_letter = pytest.mark.skipif(
    not os.environ.get("LABIAL_RUNTIME_PAPER"),
    reason="LABIAL_RUNTIME_PAPER names no build to the letter: cmake --build builds it as labial-python-paper")


def run(*command: str) -> subprocess.CompletedProcess:
    """Python with the run-time that is built to the letter."""
    environment = {**os.environ, "LABIAL_RUNTIME": os.environ["LABIAL_RUNTIME_PAPER"]}
    return subprocess.run([sys.executable, *command], env=environment, cwd=HERE, capture_output=True, text=True)


@needs_letter
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(1, 6))])
def test_every_frame_is_that_of_the_published_method(seed: int) -> None:
    """Any other state, cut or join is far beyond one FAP unit, RMS .25 after rounding; .6 before."""
    done = run("published_player.py", str(seed))
    assert done.returncode == 0, done.stderr
    differences = []
    for name, (found, wanted) in json.loads(done.stdout).items():
        frames, expected = np.array(found).reshape(-1, 13), np.array(wanted).reshape(-1, 13)
        assert frames.shape == expected.shape, name
        limit = 1.3 if name == "articulated" else 1.0
        assert np.abs(frames - expected).max(initial=0) <= 0.6 * limit, name
        differences.append(frames - np.floor(expected + 0.5))
        assert np.abs(differences[-1]).max(initial=0) <= 1, name
    assert sum(map(len, differences)) > 1000
    assert np.sqrt(np.mean(np.concatenate(differences) ** 2)) <= 0.25


@needs_letter
def test_check_compares_with_the_published_method(given: Path) -> None:
    """`labial check` tells what the library is built for; one that is built to the letter refuses other models."""
    paper, other = (run("-m", "labial", "check", str(given / f"{name}.npz"), str(given / "phones.lab"),
                        "--predecessors", "12") for name in ("paper", "labial"))
    assert paper.returncode == 0, paper.stderr
    assert re.search(r"published method by [0-9.]+ FAP units RMS: it is that method", paper.stdout)
    assert other.returncode == 1 and "train it by --method paper" in other.stderr


# ---- Models of ``--method paper`` ------------------------------------------------------------------------------------


def frames_of(given: Path, name: str, module) -> np.ndarray:
    """The motion by one of the references, which differ by more than rounding."""
    model = load(given / f"{name}.npz")
    return module.synthesise(FloatTables(model), read_stream(given / "phones.lab", model))


@pytest.fixture
def wanted(given: Path) -> np.ndarray:
    frames = frames_of(given, "paper", published)
    assert np.abs(frames - frames_of(given, "paper", steps)).max() > 1
    return frames


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_has_the_published_motion(given: Path, wanted: np.ndarray, name: str) -> None:
    """Would catch a format that takes its frames from another reference."""
    assert main(["synth", "paper.npz", "phones.lab", "--to", name, "-o", "out"]) == 0
    text = io.StringIO()
    model = load("paper.npz")
    spoken = [(model.phonemes[phoneme], length) for phoneme, length in read_stream("phones.lab", model)]
    FORMATS[name].write(text, [with_shares(wanted, spoken, 50)], 50, "paper", len(wanted))
    assert Path("out").read_text() == text.getvalue()


def test_whole_utterances_and_labials_models_are_as_they_were(given: Path) -> None:
    """The published method's `--whole` is one unit; Labial's models move as the run-time does."""
    for name, option, expected in (
        ("paper", ["--whole"], published.synthesise(
            FloatTables(load("paper.npz")), read_stream("phones.lab", load("paper.npz")), whole=True)),
        ("labial", [], delivered(frames_of(given, "labial", steps))),
        ("labial", ["--exact"], delivered(frames_of(given, "labial", steps), exact=True)),
    ):
        assert main(["synth", f"{name}.npz", "phones.lab", "-o", "out.csv", *option]) == 0
        np.testing.assert_allclose(read_frames(Path("out.csv"))[1], expected, atol=0.00501)


def test_page_plot_and_bake_have_the_published_motion(given: Path, wanted: np.ndarray) -> None:
    """Also what a board plays back that does not compute; there it begins and ends at rest."""
    [read] = motion.read_motions([given / "paper.npz"], given / "phones.lab")
    np.testing.assert_array_equal(read.frames, wanted)
    track = read_track(Source(str(given / "phones.lab"), str(given / "paper.npz"))).frames
    np.testing.assert_array_equal(track, delivered(wanted))


def test_check_says_what_the_device_does_differently(given: Path, wanted: np.ndarray,
                                                     capsys: pytest.CaptureFixture) -> None:
    """One sentence, whose figure is that of the library's own reference, and no defect of what differs by design."""
    model = load(given / "paper.npz")
    device = steps.synthesise(ExportedTables(quantise(model, "m")), read_stream(given / "phones.lab", model))
    rms = float(np.sqrt(np.mean((device - wanted) ** 2)))
    assert main(["check", str(given / "paper.npz"), str(given / "phones.lab")]) == 0
    captured = capsys.readouterr()
    assert f"differs from the published method by {rms:.1f} FAP units RMS, by design" in captured.out and rms > 1
    assert "published method: rms" in captured.out and captured.out.count("by design") == 1 and captured.err == ""
    # The made-up model's paths flip at near ties, so its verdict is open; the comparison on the same tables is not.
    status = main(["check", str(given / "labial.npz"), str(given / "phones.lab"), "--predecessors", "12"])
    captured = capsys.readouterr()
    assert "90 frames" in captured.out and "open_jaw" in captured.out and "published" not in captured.out
    assert "same tables" not in captured.err and status == (1 if captured.err else 0)


@pytest.mark.slow
def test_export_says_it_too(given: Path, capsys: pytest.CaptureFixture, few_streams: None) -> None:
    assert main(["export", str(given / "paper.npz"), "--name", "m", "-o", str(given / "out")]) == 0
    text = capsys.readouterr().out
    assert "from the published method, FAP" in text and "by design" in text and "quantisation loss" not in text


def test_bundled_models_by_name(given: Path, capsys: pytest.CaptureFixture, few_streams: None) -> None:
    """In every command that takes a model; a file of the same name is another thing."""
    Path("hello.lab").write_text("0 0.2 SIL\n0.2 0.3 B\n0.3 0.5 AY\n0.5 0.8 SIL\n")
    Path("laugh.lab").write_text("0 0.2 silence\n0.2 0.3 a\n0.3 0.5 silence\n")
    for command in ("synth speech_en hello.lab --to jsonl -o a.jsonl", "synth laughter_synthetic laugh.lab -o a.csv",
                    "page speech_en --phones hello.lab -o a.html", "bake hello.lab --model speech_en -o a.h",
                    "export speech_en --name own -o own"):
        assert main(command.split()) == 0
    assert len(Path("a.jsonl").read_text().splitlines()) == 52 and Path("a.h").exists()
    capsys.readouterr()
    assert main(["synth", "./speech_en", "hello.lab"]) == 1
    assert "speech_en: No such file" in capsys.readouterr().err
    assert main(["page", "speech_en", "-o", "hello.html"]) == 1
    assert "speech_en: a model speaks phoneme timings: give --phones" in capsys.readouterr().err


# ---- The published method with its open choices made otherwise -------------------------------------------------------


@pytest.fixture(scope="module")
def corpus():
    return planted(law, 14, noise=3.0)


@pytest.fixture(scope="module")
def training(corpus) -> Training:
    return Training(utterances(corpus[:11], SPEECH, 50), SPEECH, 50, 0)


def test_the_first_row_is_the_published_method(corpus, training) -> None:
    """The same frames as the row `paper` of an evaluation."""
    given = [item.timeline for item in utterances(corpus[11:], SPEECH, 50)]
    motion = choices._motion(CHOICES["speech"][0], training, given)
    for frames, item in zip(motion, given):
        np.testing.assert_array_equal(frames, methods.reference(training.model("paper"))(item))


@pytest.mark.slow
def test_every_choice_changes_something_and_leaves_nothing_behind(corpus, training) -> None:
    """Would catch a choice that is not made, and one that is still made in the next row."""
    given = [utterances(corpus[11:], SPEECH, 50)[0].timeline]
    kept = [codebook.VARIANCE_FLOOR, codebook.transitions, shapes.SAMPLES_PER_COMPONENT, shapes.REGULARISATION,
            published.join, published.OVERLAP, published.PIECE_MAX, pipeline.PHONE_SETS]
    plain = choices._motion(Choice(""), training, given)[0]
    same = []
    for choice in CHOICES["speech"][1:]:
        if np.array_equal(choices._motion(choice, training, given)[0], plain):
            same.append(choice.title)
    # This corpus's apexes are the middles, and it has no unit of more than 40 frames.
    assert set(same) <= {"a phoneme's middle, not the apex of its sound", "units of any length, not cut at 40 frames",
                         "cross-fade of 20 frames at most, not 8"}
    assert [codebook.VARIANCE_FLOOR, codebook.transitions, shapes.SAMPLES_PER_COMPONENT, shapes.REGULARISATION,
            published.join, published.OVERLAP, published.PIECE_MAX, pipeline.PHONE_SETS] == kept
    np.testing.assert_array_equal(choices._motion(Choice(""), training, given)[0], plain)


def test_full_covariances_without_covariances_are_the_diagonal_ones(training) -> None:
    """Equation 3 with the matrix written out, against the solver of the published reference."""
    model = training.model("paper")
    path = np.random.default_rng(1).integers(0, model.log_initial.shape[1], (30, 13))
    inverse = np.zeros((*model.state_precision.shape[:2], 3, 3))
    inverse[..., np.arange(3), np.arange(3)] = model.state_precision
    terms = FloatTables(model).equation(path, np.zeros((30, 13)))
    np.testing.assert_allclose(choices._solve_full(model, inverse, path), published.solve(terms), atol=1e-6)


def test_a_cut_lies_in_the_middle_of_what_two_pieces_share() -> None:
    pieces = [Piece(0, 10, 0, 4), Piece(6, 15, 4, 0)]
    motion = [np.full((10, 13), 1.0), np.full((9, 13), 2.0)]
    assert choices._cut_in_the_middle(pieces, motion)[:, 0].tolist() == [1.0] * 8 + [2.0] * 7
    assert 1.0 < join(pieces, motion)[7, 0] < 2.0


def test_laughs_have_their_boundaries_changed() -> None:
    """The phone set of the training alone: what is judged stays as it was."""
    by_title = {choice.title: choice for choice in CHOICES["laughter"]}
    every = by_title["every phoneme ends a unit"].replaced[pipeline, "PHONE_SETS"]["laughter"]
    silence = by_title["silence alone ends a unit"].replaced[pipeline, "PHONE_SETS"]["laughter"]
    assert all(every.boundary) and sum(silence.boundary) == 1 and silence.boundary[0]
    assert 1 < sum(PHONE_SETS["laughter"].boundary) < len(PHONE_SETS["laughter"].boundary)


# ---- Labial's departures from the published method -------------------------------------------------------------------


def test_every_departure_changes_something(corpus, training) -> None:
    """Would catch a row that measures the model as it is. This corpus has pairs too few to be learnt."""
    timeline = utterances(corpus[11:], SPEECH, 50)[0].timeline
    model = training.model("labial")
    plain = DEPARTURES[0].synthesise(model, timeline)
    same = {item.title for item in DEPARTURES[1:] if np.array_equal(item.synthesise(item.back(model), timeline), plain)}
    assert same <= {"pairs"}


def test_units_of_a_published_model_are_the_published_ones(corpus, training) -> None:
    """The row of units and joins is the published reference, which test_published.py holds against other programs."""
    timeline = utterances(corpus[11:], SPEECH, 50)[0].timeline
    model = training.model("paper")
    np.testing.assert_array_equal(departures._unit_by_unit(model, timeline),
                                  published.synthesise(FloatTables(model), timeline.stream))


@pytest.mark.slow
@pytest.mark.parametrize("command, head, variants", [(choices, "choice", len(CHOICES["speech"])),
                                                     (departures, "taken back", 1 + len(DEPARTURES))])
def test_variants_are_a_table(corpus, tmp_path: Path, capsys: pytest.CaptureFixture, command, head: str,
                              variants: int) -> None:
    (tmp_path / "corpus").mkdir()
    for item in corpus:
        write_episode(tmp_path / "corpus", item)
    assert command.main([str(tmp_path / "corpus"), "--splits", "1", "--jobs", "1", "-o", str(tmp_path / "t.md")]) == 0
    lines = (tmp_path / "t.md").read_text().splitlines()
    assert lines[0] == f"| {head} | diff | correlation | amplitude | closure | jitter | seam |"
    assert len(lines) == 2 + variants and all(line.count("|") == 8 for line in lines)
    assert capsys.readouterr().out == "\n".join(lines) + "\n"
    assert command.main([str(tmp_path / "nothing"), "-o", str(tmp_path / "t.md")]) == 1
    assert "nothing: no such folder" in capsys.readouterr().err
