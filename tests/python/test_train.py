"""The whole training on a small synthetic corpus: the same bytes always, and motion that follows the phonemes."""

from __future__ import annotations

import io
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from labial.corpus import Episode, Segment, resample
from labial.corpus.phonesets import SPEECH
from labial.errors import LabialError
from labial.reference import stream as carried_on
from labial.reference.synthesis import synthesise
from labial.reference.tables import FloatTables
from labial.tables.followers import columns
from labial.tables.model import Model, save
from labial.train import backed_off, kernels, pipeline, train
from labial.train.codebook import features, lbg
from labial.train.pipeline import _unit_ends, codebook_tables, train_channel
from labial.train.recordings import Recording, with_pauses_cut
from labial.train.states import DYNAMIC_RANGE, Scales, StateTables, limit_range, match_states

LABELS = ("P", "AA", "T", "IY", "UW", "S", "K")
OPTIONS = {"kind": "speech", "codebook": 12, "components": 2, "progress": False, "attribution": "synthetic"}


def episode(seed: int, pause: float = 0.0) -> Episode:
    """Thirty phonemes, each with a lip shape of its own that the mouth glides to, recorded at 100 frames/s; with a
    pause of so many seconds in the middle, if any."""
    rng = np.random.default_rng(seed)
    labels = ["SIL", *rng.choice(LABELS, 28), "SIL"]
    lengths = rng.integers(5, 16, 30) / 100.0
    if pause:
        labels[15], lengths[15] = "SIL", pause
    ends = np.cumsum(lengths)
    shape = {label: np.random.default_rng(index).normal(0, 150, 13) for index, label in enumerate(("SIL", *LABELS))}
    times = np.arange(0.0, ends[-1], 0.01) + 0.005
    steps = np.stack([shape[labels[index]] for index in np.searchsorted(ends, times).clip(max=29)])
    window = np.hanning(13) / np.hanning(13).sum()
    held = np.pad(steps, ((6, 6), (0, 0)), mode="edge")
    frames = np.stack([np.convolve(channel, window, "valid") for channel in held.T], axis=1)
    segments = [Segment(end - length, end, label) for end, length, label in zip(ends, lengths, labels)]
    return Episode(f"e{seed}", times, frames + rng.normal(0, 2, frames.shape), tuple(segments))


def symmetric(item: Episode) -> Episode:
    """The same with both sides of the mouth as the left one moves, which is what `labial` learns by default."""
    frames = item.frames.copy()
    frames[:, 6::2] = frames[:, 5::2]
    return replace(item, frames=frames)


@pytest.fixture(scope="module")
def corpus():
    return [episode(seed) for seed in range(24)]


@pytest.fixture(scope="module")
def models(corpus):
    return {method: train(corpus, method=method, jobs=1, symmetric=False, **OPTIONS) for method in ("paper", "labial")}


def saved(model: Model) -> bytes:
    buffer = io.BytesIO()
    save(model, buffer)
    return buffer.getvalue()


def motion_error(model: Model, item: Episode) -> float:
    """RMS error over the motion's standard deviation, on frames of 20 ms."""
    stream = [(model.phonemes.index(s.label), round(1000 * s.duration)) for s in item.segments]
    found = synthesise(model, stream)
    centre = (np.arange(len(found)) + 0.5) / model.fps
    human = np.stack([np.interp(centre, item.times, channel) for channel in item.frames.T], axis=1)
    return float(np.sqrt(((found - human) ** 2).mean()) / human.std())


def test_models_reproduce_unseen_episodes(models):
    # Catches a sign, lag, unit or table order that training and run-time do not share. The mean alone would give 1.
    unseen = [episode(seed) for seed in (100, 101)]
    errors = {method: np.mean([motion_error(model, item) for item in unseen]) for method, model in models.items()}
    assert errors["labial"] < 0.25
    assert errors["paper"] < 0.25


@pytest.mark.slow
def test_both_sides_learn_their_mean(corpus):
    """Would catch a side that is learnt alone, and one that moves by itself; the published method learns both."""
    model = train(corpus, method="labial", jobs=1, **OPTIONS)
    swapped = [replace(item, frames=item.frames[:, [0, 1, 2, 3, 4, 6, 5, 8, 7, 10, 9, 12, 11]]) for item in corpus]
    other = train(swapped, method="labial", jobs=1, **OPTIONS)
    assert model.source.tolist() == [0, 1, 2, 3, 4, 5, 5, 7, 7, 9, 9, 11, 11]
    for name in ("shape", "kernel", "floor"):
        value = getattr(model, name)
        np.testing.assert_array_equal(value[..., 5::2], value[..., 6::2])
        np.testing.assert_array_equal(value, getattr(other, name))
    np.testing.assert_array_equal(model.state_mean, other.state_mean)
    assert train(corpus, method="paper", jobs=1, **OPTIONS).source.tolist() == [*range(13)]


def test_tables_are_those_of_their_method(models):
    # Catches additions that leak into the method that comparisons call the paper's, -inf where the search could come to
    # a dead end, and precisions that 8-bit weights cannot hold together: the library's range is 1 : 4095.
    paper, own = models["paper"], models["labial"]
    assert not paper.soft and not paper.slope.any() and not paper.state_anchor.any()
    assert paper.kernel.shape == (40, 0, 13) and paper.log_previous.shape[1] == 0
    for model in models.values():
        assert np.isfinite(model.log_initial).all()
        assert np.isfinite(np.diagonal(model.log_transition, axis1=1, axis2=2)).all()
        np.testing.assert_allclose(np.exp(model.log_transition).sum(axis=2), 1)
        np.testing.assert_allclose(np.exp(model.log_initial).sum(axis=1), 1)
    hold = own.state_precision[..., 0] + own.state_anchor
    whole = hold + own.state_precision[..., 1] / 2 + 6 * own.state_precision[..., 2]
    assert (whole.max(axis=1) / hold.min(axis=1) < 4095).all()


def test_features_are_clustered_as_they_are_unless_asked(corpus, models):
    """The text does not normalise them. Would catch a scale that leaks in, and an option that is lost on its way."""
    normalised = train(corpus, method="paper", jobs=1, normalise=True, **OPTIONS)
    assert models["paper"].training["normalised_features"] is False
    assert normalised.training["normalised_features"] is True and "normalised_features" not in models["labial"].training
    rows = np.concatenate([features(resample(item, 50).motion[:, 0]) for item in corpus])
    for model, scale in ((models["paper"], 1.0), (normalised, rows.std(axis=0))):
        centres, _, _ = lbg(rows / scale, OPTIONS["codebook"])
        wanted = (centres * scale)[np.lexsort((centres * scale).T[::-1])]
        np.testing.assert_allclose(model.state_mean[0], wanted, atol=2.0)


def test_every_phoneme_has_shapes_and_back_offs_are_told(models):
    # Catches a phoneme missing from the model, or replaced without a word.
    model = models["labial"]
    told = "\n".join(backed_off(model))
    assert model.phonemes == SPEECH.phonemes and (model.component_count >= 1).all()
    pooled = model.training["pooled"]
    for label in set(SPEECH.phonemes) - {"SIL", *LABELS}:
        assert (label in pooled) != (label in model.substitutes)
        assert f"{label}: 0 samples" in told
    assert pooled["B"] == "bilabial" and model.substitutes["F"] in LABELS
    assert "P: " not in told


def test_wild_precisions_are_limited():
    # Catches a limit that changes what is within it, or does not reach what is beyond.
    precision = np.full((13, 3, 3), 0.01)
    anchor = np.full((13, 3), 0.01)
    same, same_anchor = limit_range(precision, anchor)
    np.testing.assert_array_equal(same, precision)
    np.testing.assert_array_equal(same_anchor, anchor)
    precision[2, 1, 2] = 1e9
    anchor[3, 0] = 1e9
    limited, limited_anchor = limit_range(precision, anchor)
    hold = limited[..., 0] + limited_anchor
    whole = hold + limited[..., 1] / 2 + 6 * limited[..., 2]
    assert (whole.max(axis=1) <= DYNAMIC_RANGE * hold.min(axis=1)).all()
    np.testing.assert_array_equal(limited[2, [0, 2]], precision[2, [0, 2]])


def test_matched_states_follow_the_human_under_them():
    # Catches statistics of the target instead of the human motion, and anchors of the wrong variance.
    rng = np.random.default_rng(0)
    human = np.repeat(np.where(np.arange(4000) // 500 % 2, 100.0, -100.0)[:, None], 13, axis=1)
    human = human + rng.normal(0, [5.0] * 12 + [20.0], human.shape)
    books = [train_channel([human[:, channel]], [np.array([0])], 2) for channel in range(13)]
    tables = codebook_tables(books, 2)
    path = (human > 0).astype(np.int64)
    target = np.where(human > 0, 90.0, -90.0)
    weight = np.full(human.shape, 3.0)
    weight[1000:2000] = 0.0  # what does not count may be anything
    human[1000:2000] = 1e3
    matched = match_states(tables, [path], [target], [human], [weight], Scales(static=0.5, anchor=2.0))
    np.testing.assert_allclose(matched.state_mean[:, :, 0], np.tile([-100.0, 100.0], (13, 1)), atol=2)
    np.testing.assert_allclose(0.5 / matched.state_precision[0, :, 0], 25, rtol=0.2)
    np.testing.assert_allclose(2.0 / matched.state_anchor[12], 400, rtol=0.2)
    np.testing.assert_array_equal(matched.emission_mean, tables.emission_mean)
    # From one state to the other every 500 frames, that is every 250 of the path's steps, and half a count more.
    np.testing.assert_allclose(np.exp(matched.log_transition[:, 0, 1]), 4.5 / 1001, rtol=0.01)


def test_training_sees_what_the_run_time_will_do(monkeypatch):
    """Targets and state paths in training are those of the finished model on the same phonemes: a pause that is cut in
    one alone, another grid of blocks or end of a unit, or another target, would train for what never happens."""
    seen = {}

    def matched(tables, paths, targets, *others):
        seen.update(tables=tables, paths=paths, targets=targets)
        return match_states(tables, paths, targets, *others)

    monkeypatch.setattr(pipeline, "match_states", matched)
    unchanged = np.ones(13), np.zeros(13)
    monkeypatch.setattr(pipeline, "gains", lambda *_: unchanged)  # would widen what was seen
    corpus = [episode(seed, 0.3 + 0.05 * seed) for seed in range(8)]
    model = train(corpus, method="labial", jobs=1, search_stride=3, **OPTIONS)
    searched = seen["tables"].log_transition[columns(model.source)]
    tables = FloatTables(replace(model, log_transition=searched))
    for item, path, target in zip(corpus, seen["paths"], seen["targets"]):
        bounds = [round(1000 * segment.end) for segment in item.segments]
        stream = list(zip([model.phonemes.index(s.label) for s in item.segments], np.diff([0, *bounds]).tolist()))
        given, _, ends = carried_on.aims(tables, stream)
        np.testing.assert_allclose(target, given, atol=1e-9)
        assert target.shape == (len(given), 9)
        np.testing.assert_array_equal(path, tables.search(given, ends))


def test_pauses_are_cut_by_hand():
    """A pause of 20 frames before a vowel, six of which see it: 280 and 120 ms; apexes stay where they were."""
    item = Recording("a", np.array([0, 3, 0]), np.array([0.401, 0.1, 0.12]), np.array([20, 5, 6]),
                    np.array([15, 22, 26]), np.zeros((31, 13)))  # fmt: skip
    found = with_pauses_cut(item, 0, 6, 50)
    assert found.phoneme.tolist() == [0, 0, 3, 0] and found.length.tolist() == [14, 6, 5, 6]
    np.testing.assert_allclose(found.duration, [0.281, 0.12, 0.1, 0.12])
    assert found.apex.tolist() == [7, 15, 22, 26]  # the head's is its middle
    assert found.phoneme_at().tolist() == item.phoneme_at().tolist()
    assert with_pauses_cut(item, 0, 0, 50).length.tolist() == [20, 5, 6]
    ends = _unit_ends(found, np.arange(4) == 3)
    assert np.flatnonzero(ends).tolist() == [24, 30]


def test_transitions_are_counted_on_each_channels_own_blocks():
    """Stride 3, twelve frames: channel 0 decides with frames 0, 3, 6, 9 and 11, channel 1 with 1, 4, 7, 10 and 11.
    Counting every third frame for all channels would count other chains."""
    rng = np.random.default_rng(0)
    human = rng.normal(0, 50, (12, 13))
    tables = codebook_tables([train_channel([human[:, k]], [np.array([0])], 3, 3) for k in range(13)], 3)
    states = np.array([0, 1, 1, 1, 2, 2, 2, 0, 0, 0, 1, 1])
    path = np.repeat(states[:, None], 13, axis=1)
    path[:, 1] = [0, 0, 1, 1, 1, 2, 2, 2, 0, 0, 0, 1]
    weights = np.ones_like(human)
    matched = match_states(tables, [path], [human], [human], [weights], Scales())
    for k in (0, 1):  # both chains are 0 1 2 0 1
        counts = np.array([[0.5, 2.5, 0], [0.5, 0.5, 1.5], [1, 0.5, 0.5]])
        np.testing.assert_allclose(np.exp(matched.log_transition[k]), counts / counts.sum(axis=1, keepdims=True))


@pytest.mark.parametrize(
    "wrong", [{"method": "other"}, {"kind": "song"}, {"codebook": 65}, {"components": 9}, {"fps": 0}, {"jobs": 0}]
)
def test_options_out_of_range_are_refused(corpus, wrong):
    # Catches a model that no device could hold, found out only after the training.
    with pytest.raises(LabialError):
        train(corpus, **{**OPTIONS, "method": "paper", **wrong})


def test_labels_and_corpora_that_cannot_be_used(corpus):
    # Catches a KeyError in place of a message that names the episode.
    with pytest.raises(LabialError, match="empty"):
        train([], method="paper", **OPTIONS)
    strange = replace(corpus[0], segments=(replace(corpus[0].segments[0], label="QQ"), *corpus[0].segments[1:]))
    with pytest.raises(LabialError, match="QQ"):
        train([strange], method="paper", **OPTIONS)


@pytest.mark.slow
def test_blocks_do_not_change_the_model(corpus, models, monkeypatch):
    """Catches sums whose last bit depends on how many frames are taken in at a time."""
    taken = []
    real = kernels._Sums.add

    def counted(self, design, *rest):
        taken.append(design.shape[0])
        real(self, design, *rest)

    monkeypatch.setattr(kernels, "BLOCK", 500)
    monkeypatch.setattr(kernels._Sums, "add", counted)
    assert saved(train(corpus, method="labial", jobs=1, symmetric=False, **OPTIONS)) == saved(models["labial"])
    assert len(taken) > 3 and max(taken) < 1500


def test_states_are_matched_channel_by_channel():
    """What a frame takes, bytes: catches copies of all channels of all frames, which took 500."""
    rng = np.random.default_rng(0)
    size, frames = 8, (500, 13)
    mean = np.sort(rng.normal(0, 50, (13, size)), axis=1)
    tables = StateTables(mean, np.ones((13, size)), np.zeros((13, size, 3)), np.ones((13, size, 3)),
                         np.zeros((13, size)), np.zeros((13, size, size)), np.zeros((13, size)), 3)
    paths = [rng.integers(0, size, frames) for _ in range(40)]
    human = [rng.normal(size=frames) for _ in paths]
    weights = [np.broadcast_to(1.0, frames)] * len(paths)
    tracemalloc.start()
    match_states(tables, paths, human, human, weights, Scales())
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 200 * frames[0] * len(paths)
