"""Several corpora and talkers: what ``corpus.toml`` says, one scale for all, and what is learnt of whom."""

from __future__ import annotations

import shutil
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import List

import numpy as np
import pytest

from labial.__main__ import main
from labial.corpus import Episode, Segment, Source, read_corpora, read_corpus, resample
from labial.corpus.phonesets import SPEECH
from labial.errors import DataError, LabialError
from labial.evaluate import protocol
from labial.evaluate.measures import lips
from labial.tables.followers import solved
from labial.tables.model import load, save
from labial.train import adapted, train
from labial.train.expression import motion_of
from labial.train.kernels import Penalties, _design, fit_kernels, regression
from labial.train.recordings import Recording, occurrences, recordings
from labial.train.talkers import SHARED, fit_talkers, weights_of
from models import write_episode, write_motion
from packages import SOURCE
from test_shapes import CLASS, FPS, PHONEMES, choice_of, episode, tables
from test_train import OPTIONS, motion_error, symmetric
from test_train import episode as spoken

TOML = """weight = 3
leave_out = ["fap16", "fap17"]
silences = false
[talkers]
anna = ["anna_*"]
bert = ["bert_in_?", "bert_out"]
"""
NAMES = ("anna_1", "anna_2", "bert_in_1", "bert_out")


def corpus(folder: Path, names=NAMES, toml: str = "", scale: float = 1.0, offset: float = 0.0) -> Path:
    """A folder of episodes of a second of silence and a second of AA, at 50 frames/s."""
    folder.mkdir()
    for number, name in enumerate(names):
        values = np.random.default_rng([len(names), number]).normal(0, 10, (100, 13)) * scale + offset
        values[:50] += 1000.0
        write_motion(folder / f"{name}.csv", 0.01 + 0.02 * np.arange(100), values)
        (folder / f"{name}.lab").write_text("0 1 SIL\n1 2 AA\n")
    if toml:
        (folder / "corpus.toml").write_text(toml)
    return folder


def test_the_file_tells_talkers_weights_and_what_is_left_out(tmp_path) -> None:
    # Catches a key that is read but lost on the way to the training.
    found = read_corpus(corpus(tmp_path / "c", toml=TOML))
    assert [item.source.talker for item in found] == ["anna", "anna", "bert", "bert"]
    assert len({item.source.recording for item in found}) == 3
    assert {(item.source.weight, item.source.left_out, item.source.silences) for item in found} == {
        (3.0, frozenset({1, 2}), False)}
    first = recordings(found, SPEECH, 50)[0]
    assert not first.weights[:50].any() and not first.weights[:, 1:3].any()
    assert (first.weights[50:, 3:] == 3.0).all() and first.learnt().tolist() == [False, True]
    plain = read_corpus(corpus(tmp_path / "plain"))
    assert {(item.source.talker, item.source.weight) for item in plain} == {("plain", 1.0)}
    assert recordings(plain, SPEECH, 50)[0].weight is None


@pytest.mark.parametrize(("old", "new", "message"), [
    ("weight = 3", "weight = = 3", ":1: not TOML: "),
    ("weight = 3", "wait = 3", ": wait: unknown key; did you mean weight?"),
    ("weight = 3", "weight = 0", ": weight: 0 is not above 0 and at most 1000"),
    ("weight = 3", 'weight = "3"', ": weight: '3' is not a number"),
    ("silences = false", "silences = 0", ": silences: 0 is neither true nor false"),
    ('["fap16", "fap17"]', '"fap16"', ": leave_out: is not a list of channels"),
    ('"fap16"', '"fap18"', ": leave_out: no channel is called 'fap18'; did you mean fap"),
    ('"fap16"', "16", ": leave_out: no channel is called 16"),
    ('"fap16"', "[1]", ": leave_out: no channel is called [1]"),
    ("silences = false", 'scale = "fap53"', ": scale: is not a list of channels"),
    ("silences = false", 'scale = ["fap5"]', ": scale: no channel is called 'fap5'; did you mean fap"),
    ('["fap16", "fap17"]', str([f"fap{n}" for n in (3, 16, 17, *range(51, 61))]), ": leave_out: nothing is left"),
    ('["anna_*"]', '"anna_*"', ": talkers.anna: is not a list of names or patterns"),
    ('["anna_*"]', "[3]", ": talkers.anna: is not a list of names or patterns"),
    ('"anna_*"', '"emma_*"', ": talkers.anna: no episode is called 'emma_*'"),
    ('"anna_*"', '"*"', ": talkers.bert: bert_in_1 is 'bert_in_?', but also '*' of anna"),
    ('"bert_in_?", ', "", ": talkers: nobody is told to speak in bert_in_1"),
    ("[talkers]\nanna", "talkers = 3\n[other]\nanna", ": "),
])
def test_errors_name_the_file_and_the_line_or_key(tmp_path, old: str, new: str, message: str) -> None:
    # Catches a slip that is passed over, so that a talker counts twice or not at all.
    assert old in TOML
    folder = corpus(tmp_path / "c", toml=TOML.replace(old, new))
    with pytest.raises(DataError) as caught:
        read_corpus(folder)
    assert str(caught.value).startswith(f"{folder / 'corpus.toml'}{message}")
    assert "\n" not in str(caught.value)


def test_recordings_are_brought_to_the_first_corpus(tmp_path) -> None:
    # Catches means or scales taken over silence, per corpus instead of per recording, or the wrong way round.
    first = corpus(tmp_path / "first", ["x"], scale=2.0, offset=30.0)
    second = corpus(tmp_path / "second", toml=TOML, scale=0.5, offset=-300.0)
    (alone,) = read_corpora([first])
    (one, others) = read_corpora([first, second])
    np.testing.assert_array_equal(one[0].frames, alone[0].frames)
    goal = one[0].frames[50:]
    for talker, members in (("anna", others[:2]), ("in", others[2:3]), ("out", others[3:])):
        speech = np.concatenate([item.frames[50:] for item in members])
        np.testing.assert_allclose(speech.mean(axis=0), goal.mean(axis=0), err_msg=talker)
        np.testing.assert_allclose(speech.std(axis=0), goal.std(axis=0), err_msg=talker)
    still = read_corpus(second)[3]
    moved = others[3].frames
    np.testing.assert_allclose(np.corrcoef(moved[:, 4], still.frames[:, 4])[0, 1], 1.0)


def test_a_corpus_is_named_once(tmp_path, capsys) -> None:
    # Catches a corpus that counts twice, and an evaluation of what was trained on: by the same folder or by a copy.
    first = corpus(tmp_path / "first")
    (tmp_path / "link").symlink_to(first)
    for again in (first, f"{first}/", tmp_path / "link", first / ".." / "first"):
        with pytest.raises(DataError, match="the same folder as .*; name each corpus once"):
            read_corpora([first, again])
    shutil.copytree(first, tmp_path / "copy")
    assert len(read_corpora([first, tmp_path / "copy"])) == 2
    for command in (["--methods", "mean"], ["--leave-out-talkers", "--methods", "mean"]):
        assert main(["evaluate", str(first), str(tmp_path / "copy"), "-o", str(tmp_path / "r"), *command]) == 1
        assert f"copy/anna_1: the same motion as {first}/anna_1: " in capsys.readouterr().err


def test_folders_of_one_name_are_talkers_of_their_own(tmp_path) -> None:
    # Catches two people who count as one, as anna/corpus and bert/corpus did, and one person's name that is lost.
    folders = []
    for name, toml in (("anna", ""), ("bert", ""), ("carl", TOML)):
        (tmp_path / name).mkdir()
        folders.append(corpus(tmp_path / name / "corpus", toml=toml))
    alone = corpus(tmp_path / "alone")
    talkers = [{item.source.talker for item in found} for found in read_corpora([*folders, alone])]
    assert talkers == [{"anna/corpus"}, {"bert/corpus"}, {"anna", "bert"}, {"alone"}]


def test_motion_that_is_unknown_is_not_learnt(tmp_path) -> None:
    # Catches a straight line that is learnt where frames are lost, a face that is held for phonemes after the last
    # frame, and a rest that is lost where only silence is.
    folder = corpus(tmp_path / "c")
    times = 0.01 + 0.02 * np.arange(100)
    for name, kept, lab in (("anna_1", (times < 1.2) | (times > 1.6), "0 1 SIL\n1 2 AA\n"),
                            ("anna_2", times < 1.5, "0 1 SIL\n1 1.6 AA\n1.6 2 B\n"),
                            ("bert_in_1", times < 1.8, "0 1 SIL\n1 1.8 AA\n1.8 2.4 SIL\n")):
        write_motion(folder / f"{name}.csv", times[kept], np.random.default_rng(0).normal(0, 9, (kept.sum(), 13)))
        (folder / f"{name}.lab").write_text(lab)
    with pytest.warns(UserWarning, match=r"c/anna_1: no motion from 1.19 to 1.61 s \(and 1 more\): nothing is "):
        found = read_corpus(folder)
    gap, end, *rest = recordings(found, SPEECH, 50)
    assert np.flatnonzero(~gap.weights.any(axis=1)).tolist() == list(range(60, 80))
    assert np.flatnonzero(~end.weights.any(axis=1)).tolist() == list(range(75, 100))
    assert all(item.weight is None for item in rest)
    assert end.learnt().tolist() == [True, True, False]
    assert occurrences([gap, end], SPEECH).learnt.tolist() == [True, False, True, True, False]


def test_a_corpus_that_teaches_nothing_is_refused(tmp_path) -> None:
    # Catches a model of a still mouth, or of no phoneme, that looks like any other.
    still, silent = corpus(tmp_path / "still"), corpus(tmp_path / "silent")
    for name in NAMES:
        write_motion(still / f"{name}.csv", 0.01 + 0.02 * np.arange(100), np.zeros((100, 13)))
        (silent / f"{name}.lab").write_text("0 2 SIL\n")
    with pytest.raises(DataError, match="still: nothing moves"):
        read_corpora([still])
    with pytest.raises(DataError, match="silent: there is no phoneme of speech but silence"):
        read_corpora([silent])


def test_a_corpus_gives_its_scale_to_all(tmp_path) -> None:
    # Catches a scale that the first corpus or a talker keeps, another channel's, a mean that is taken along, and a
    # mouth that no longer rests where it did.
    first = corpus(tmp_path / "first", ["x"], scale=2.0, offset=30.0)
    second = corpus(tmp_path / "second", scale=0.5, offset=-300.0, toml='scale = ["fap53"]\n')
    third = corpus(tmp_path / "third", ["y"], scale=3.0)
    (alone,) = read_corpora([first])
    whole = [item.frames for items in read_corpora([first, second, third]) for item in items]
    found, plain = [frames[50:] for frames in whole], alone[0].frames[50:]
    rest = np.median(alone[0].frames[:50], axis=0)
    np.testing.assert_allclose(np.median(whole[0][:50], axis=0), rest)
    mean = plain.mean(axis=0)
    mean[5] = rest[5] + (mean[5] - rest[5]) * found[0][:, 5].std() / plain[:, 5].std()
    recordings_of_second = np.concatenate(found[1:-1])
    for speech in (found[0], recordings_of_second, found[-1]):
        np.testing.assert_allclose(speech.mean(axis=0), mean)
        np.testing.assert_allclose(np.delete(speech.std(axis=0), 5), np.delete(plain.std(axis=0), 5))
        np.testing.assert_allclose(speech[:, 5].std(), np.concatenate(
            [item.frames[50:, 5] for item in read_corpus(second)]).std())


def test_a_recording_that_does_not_move_is_only_shifted(tmp_path) -> None:
    # Catches a division by a standard deviation of 0.
    first, second = corpus(tmp_path / "a", ["x"]), corpus(tmp_path / "b", ["y"], scale=0.0, offset=7.0)
    one, others = read_corpora([first, second])
    np.testing.assert_allclose(others[0].frames[50:], np.tile(one[0].frames[50:].mean(axis=0), (50, 1)))


def test_frames_within_phonemes() -> None:
    # Catches boundaries a frame off, and frames before or after all phonemes.
    times = np.array([-0.1, 0.0, 0.1, 0.19, 0.2, 0.25, 0.3, 0.4])
    segments = (Segment(0.0, 0.1, "AA"), Segment(0.1, 0.2, "SIL"), Segment(0.2, 0.3, "T"))
    found = Episode("e", times, np.zeros((8, 13)), segments).sounding("SIL")
    assert found.tolist() == [False, True, False, False, True, True, False, False]


def test_channels_that_nobody_teaches_are_refused() -> None:
    # Catches a division by a weight of 0 in the middle of the training.
    source = Source(left_out=frozenset({1}))
    with pytest.raises(LabialError, match="fap16"):
        train([replace(spoken(1), source=source)], method="paper", **OPTIONS)


def test_what_every_corpus_leaves_out_is_learnt_with_a_warning(tmp_path) -> None:
    # Catches the corpus that the repository holds, trained on alone, that is refused.
    addresses = SOURCE / "export" / "corpora" / "addresses"
    with pytest.warns(UserWarning, match="every corpus leaves out fap16, fap17, silences: learnt all the same"):
        (corpus,) = read_corpora([addresses])
    assert all(not item.source.left_out and item.source.silences and item.source.weight == 2 for item in corpus)
    folder = tmp_path / "all"
    shutil.copytree(addresses, folder)
    (folder / "corpus.toml").unlink()
    _, other = read_corpora([folder, addresses])
    assert all(item.source.left_out == {1, 2} and not item.source.silences for item in other)


@pytest.mark.slow
def test_what_is_left_out_does_not_reach_the_model() -> None:
    # Catches silences and channels that are learnt from all the same: here they hold nonsense.
    first = [spoken(seed) for seed in range(16)]
    source = Source(weight=2.0, left_out=frozenset({1, 2}), silences=False)
    second = [replace(spoken(seed), source=source) for seed in range(16, 22)]

    def spoilt(item: Episode) -> Episode:
        frames = item.frames.copy()
        near = np.convolve(item.sounding("SIL"), np.ones(13), "same")  # frames and velocities may reach across
        frames[near < 0.5] += 5000.0
        return replace(item, frames=frames)

    one, other = (train([*first, *more], method="labial", jobs=1, **OPTIONS)
                  for more in (second, [spoilt(item) for item in second]))
    for name in ("kernel", "pair_shape", "state_mean", "state_anchor", "floor"):
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=1e-6, atol=1e-6, err_msg=name)
    pauses = [frames for item in first for frames in resample(item, 50).length[[0, -1]]]
    assert one.training["occurrences"]["SIL"] == sum(1 + (frames > 6) for frames in pauses)  # long ones are cut in two


@pytest.mark.slow
def test_training_and_evaluation_take_several_corpora(tmp_path, capsys) -> None:
    # Catches a command that reads the first corpus alone; the talkers' table is held to the correlation itself.
    def write(folder: Path, seeds) -> Path:
        folder.mkdir()
        for seed in seeds:
            write_episode(folder, replace(symmetric(spoken(seed)), name=f"e{seed:02}"))
        return folder

    first, second = write(tmp_path / "one", range(12)), write(tmp_path / "two", range(12, 16))
    (second / "corpus.toml").write_text('weight = 2\n[talkers]\nx = ["e12", "e13"]\ny = ["e14", "e15"]\n')
    model = tmp_path / "m.npz"
    arguments = ["train", str(first), str(second), "-o", str(model), "--quiet", "--jobs", "1", "--codebook", "12",
                 "--components", "2"]  # fmt: skip
    assert main(arguments) == 0
    assert load(model).training["episodes"] == 16
    report = tmp_path / "report"
    arguments = ["evaluate", str(first), str(second), "-o", str(report), "--quiet", "--methods", "mean",
                 "--jobs", "1"]  # fmt: skip
    assert main([*arguments, "--leave-out-talkers"]) == 0
    text = (report / "report.md").read_text()
    assert "| method | x | y | mean | standard error | open_jaw |" in text and "x (2 episodes), y (2 episodes)" in text
    assert main([*arguments, "--splits", "1"]) == 0
    assert "4 episodes of further corpora" in (report / "report.md").read_text()
    assert main([*arguments[:2], *arguments[3:], "--leave-out-talkers"]) == 1
    assert "only one" in capsys.readouterr().err
    assert main([*arguments, "--leave-out-talkers", "--hold-out-words", "w"]) == 1
    assert main([*arguments, "--first-corpus-alone"]) == 1
    (a, b) = read_corpora([first, second])
    asked = protocol.Options(methods="labial", leave_out_talkers=True)
    outcomes = protocol.evaluate(a, asked, further=b, progress=False)
    assert [item.split.talker for item in outcomes] == ["x", "y"]
    assert [len(item.split.added) for item in outcomes] == [2, 2]
    assert all(item.measures["labial"]["lips/mean"] > 0.9 for item in outcomes)
    others = protocol.evaluate(a, replace(asked, talker_variance=1.0), further=b, progress=False)
    assert all(item.measures["labial"]["lips/mean"] > 0.9 for item in others)
    assert [item.measures["labial"] for item in others] != [item.measures["labial"] for item in outcomes]
    # Trained on the first corpus alone: as if there were no other talker than the one who is judged.
    alone = protocol.evaluate(a, replace(asked, first_corpus_alone=True), further=b, progress=False)
    (only,) = protocol.evaluate(a, asked, further=[item for item in b if item.source.talker == "x"], progress=False)
    found = [one.measures["labial"]["lips/mean"] for one in (alone[0], only, outcomes[0])]
    assert found[0] == found[1] != found[2]
    assert np.allclose(lips(b[0].frames)[:, 4], -(b[0].frames[:, 3] + b[0].frames[:, 4]))


# ---- Talkers as random effects ---------------------------------------------------------------------------------------


CORPORA = SOURCE / "export" / "corpora"
VARIANCE = 0.5


def material_of(talkers: str) -> List[Recording]:
    """An utterance of random motion for each letter, its talker's."""
    rng = np.random.default_rng(6)
    items = [replace(episode(rng, 25), talker=talker) for talker in talkers]
    return [replace(item, frames=rng.normal(0, 50, item.frames.shape)) for item in items]


def test_equals_the_regression_with_each_talkers_deviation_as_columns() -> None:
    # Catches a marginal that is not that of the model, another prior for what is shared, a talker whose utterances are
    # not together, an own part that is another talker's.
    material = material_of("abacab")
    choice = choice_of(material)
    asked = regression(material, tables(), CLASS, range(PHONEMES), 0, FPS, Penalties(intercept=np.inf), pair_count=9)
    shared, own = fit_talkers(asked, material, choice, VARIANCE)

    rows = _design(material, choice, asked.deviation, PHONEMES, asked.lag, 0, asked.pairs, asked.knots).toarray()
    talker = np.repeat([item.talker for item in material], [len(item.frames) for item in material])
    silent = np.concatenate([item.phoneme_at() for item in material]) == 0
    weight = np.where(silent, asked.penalties.silence, 1.0)
    base, prior, width = asked.base(material, choice), asked.prior(), rows.shape[1]
    columns = np.concatenate([rows, *((talker == name)[:, None] * rows for name in "abc")], axis=1)
    penalty = np.zeros((4 * width, 4 * width))
    for part, strength in enumerate([SHARED, *[SHARED / VARIANCE] * 3]):
        place = slice(part * width, (part + 1) * width)
        penalty[place, place] = strength * prior
    motion = np.concatenate([item.frames for item in material]) - base
    weighted = columns.T * weight
    solution = np.linalg.solve(weighted @ columns + penalty, weighted @ motion)
    parts = dict(zip(["", *"abc"], np.split(solution, 4)))
    assert list(own) == ["a", "b", "c"]
    for name, found in [("", shared), *own.items()]:
        wanted = asked.kernels(parts[""] + (parts[name] if name else 0.0), base)
        np.testing.assert_allclose(found.kernel, wanted.kernel, atol=1e-6)
        np.testing.assert_allclose(found.tables.shape, wanted.tables.shape, atol=1e-6)
        np.testing.assert_allclose(found.tables.slope, wanted.tables.slope, atol=1e-4)
        np.testing.assert_allclose(found.pair_shape, wanted.pair_shape, atol=1e-6)


def test_a_channel_that_one_talker_teaches_is_fitted_as_without_talkers() -> None:
    # Catches a channel that is shrunk twice for having one talker alone, and one that is learnt from those who leave
    # it out.
    material = material_of("aabb")
    left_out = np.ones(13)
    left_out[1] = 0.0
    material = [item if item.talker == "a" else replace(item, weight=np.ones(item.frames.shape) * left_out)
                for item in material]
    asked = regression(material, tables(), CLASS, range(PHONEMES), 0, FPS, Penalties())
    shared, own = fit_talkers(asked, material, choice_of(material), VARIANCE)
    alone = fit_kernels(asked, material[:2], choice_of(material[:2]))
    np.testing.assert_allclose(shared.kernel[..., 1], alone.kernel[..., 1], atol=1e-8)
    np.testing.assert_allclose(own["b"].kernel[..., 1], alone.kernel[..., 1], atol=1e-8)
    assert np.abs(shared.kernel[..., 2] - alone.kernel[..., 2]).max() > 0.1


def test_a_talker_who_counts_twice_is_two_talkers_alike() -> None:
    # Catches a weight that is lost, that reaches a talker's own part, or weighs the prior.
    material = material_of("abc")
    twins = [*material, *(replace(item, talker=item.talker.upper()) for item in material)]
    asked = regression(twins, tables(), CLASS, range(PHONEMES), 0, FPS, Penalties())
    wanted, own = fit_talkers(asked, twins, choice_of(twins), VARIANCE)
    heavy = [replace(item, weight=np.full(item.frames.shape, 2.0)) for item in material]
    assert weights_of([*heavy, replace(material[0], talker="d")]) == {"a": 2.0, "b": 2.0, "c": 2.0, "d": 1.0}
    found, parts = fit_talkers(asked, material, choice_of(material), VARIANCE, weights_of(heavy))
    np.testing.assert_allclose(found.kernel, wanted.kernel, atol=1e-6)
    np.testing.assert_allclose(parts["a"].kernel, own["a"].kernel, atol=1e-6)
    alike, _ = fit_talkers(asked, material, choice_of(material), VARIANCE)
    assert np.abs(alike.kernel - wanted.kernel).max() > 0.1


def two_talkers(talkers: str = "xy") -> list:
    """Episodes of test_train's talker, and of others whose motion is partly turned over, so that each has his own."""
    result = []
    for number, talker in enumerate(talkers):
        sign = np.random.default_rng(number).choice([1.0, -1.0], 13, p=[0.6, 0.4]) if number else np.ones(13)
        result += [symmetric(replace(item, frames=item.frames * sign, source=Source(talker=talker, recording=talker)))
                   for item in map(spoken, range(100 * number, 100 * number + 6))]
    return result


@pytest.fixture(scope="module")
def shared():
    return train(two_talkers(), method="labial", jobs=1, talker_variance=1.0, **OPTIONS)


@pytest.mark.slow
def test_a_model_is_adapted_to_a_talker(shared, tmp_path) -> None:
    # Catches a deviation of the wrong sign, scale or place, and pairs in another order than the file's.
    own = [item for item in two_talkers("xyz") if item.source.talker == "z"]
    mine = adapted(shared, own[:4], "z's face")
    before, after = (np.mean([motion_error(model, item) for item in own[4:]]) for model in (shared, mine))
    assert after < 0.8 * before
    assert mine.attribution == "synthetic z's face" and mine.training["adapted"]["episodes"] == 4
    order = np.random.default_rng(0).permutation(len(shared.pair_key))
    mixed = adapted(replace(shared, pair_key=shared.pair_key[order], pair_shape=shared.pair_shape[order]), own[:4])
    np.testing.assert_allclose(mixed.pair_shape, mine.pair_shape[order], atol=1e-9)
    np.testing.assert_allclose(mixed.kernel, mine.kernel, atol=1e-9)
    save(mine, tmp_path / "mine.npz")
    kept, before = load(tmp_path / "mine.npz").training["talkers"], shared.training["talkers"]
    assert all(kept[name] == before[name] for name in ("variance", "deviation", "middle"))
    again = adapted(mine, own[:4])  # what was learnt of him once is not learnt twice
    assert motion_error(again, own[4]) < 1.1 * motion_error(mine, own[4])


@pytest.mark.slow
def test_an_adapted_model_moves_as_far_as_its_talker(shared, monkeypatch: pytest.MonkeyPatch) -> None:
    # Catches the scale of the talkers who taught the shared model, and one that a second widening multiplies.
    monkeypatch.setattr("labial.train.talkers.HALF", 0.0)  # or seconds of him would count for little
    own = [item for item in two_talkers() if item.source.talker == "y"]
    channels = solved(shared.source)
    for scale in (0.5, 1.5):
        scaled = [replace(item, frames=item.frames * scale) for item in own]
        model = adapted(shared, scaled[:4])
        (human,) = recordings(scaled[5:], SPEECH, FPS)
        reached = motion_of((model, human))[:, channels].std(axis=0) / human.frames[:, channels].std(axis=0)
        assert 0.8 < np.median(reached) < 1.25 and 0.6 < reached.min() and reached.max() < 1.7


def test_what_cannot_be_adapted_is_refused(shared) -> None:
    own = two_talkers("x")
    with pytest.raises(LabialError, match="one talker, but there are x, y"):
        adapted(shared, two_talkers())
    with pytest.raises(LabialError, match="not trained with --talker-variance"):
        adapted(replace(shared, training={}), own)
    for name, value in (("gain", [1.0]), ("gain", [0.0] * 13), ("middle", None), ("variance", 1e9), ("deviation", "x")):
        with pytest.raises(LabialError, match="damaged"):
            adapted(replace(shared, training={"talkers": {**shared.training["talkers"], name: value}}), own)
    for variance in (0.0, -1.0, 1e4):
        with pytest.raises(LabialError, match="talker variance"):
            train(own, method="labial", jobs=1, talker_variance=variance, **OPTIONS)


@pytest.mark.slow
def test_the_command_adapts(shared, tmp_path, capsys) -> None:
    model, out = tmp_path / "shared.npz", tmp_path / "mine.npz"
    save(shared, model)
    folder = CORPORA / "addresses"
    assert main(["train", str(folder), "--adapt", str(model), "-o", str(out), "--quiet"]) == 1
    assert "there are a, b" in capsys.readouterr().err
    assert not out.exists()
    short = write(tmp_path / "short", folder, 1)
    assert main(["train", str(short), "--adapt", str(model), "-o", str(out), "--quiet"]) == 1
    assert "too little to adapt a model to: 5 s are the least" in capsys.readouterr().err and not out.exists()
    mine = write(tmp_path / "corpus", folder, 6)
    assert main(["train", str(mine), "--adapt", str(model), "-o", str(out), "--quiet", "--method", "paper",
                 "--look-ahead", "60"]) == 0
    told = capsys.readouterr()
    assert "adapted to 6 episodes, 2" in told.out and "--method and --look-ahead: of no effect with --adapt" in told.err
    assert "s of motion are little to adapt a model to" in told.err
    assert np.abs(load(out).kernel - shared.kernel).max() > 1.0


def write(folder: Path, source: Path, count: int) -> Path:
    """A corpus of some of the addresses."""
    with zipfile.ZipFile(source / "episodes.zip") as packed:
        names = [name for name in packed.namelist() if name.startswith("talker_b_")]
        packed.extractall(folder, sorted(names)[: 2 * count])
    return folder
