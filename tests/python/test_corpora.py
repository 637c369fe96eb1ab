"""Readers of corpora: IEMOCAP, AVLaughterCycle, and the folders that Labial itself writes."""

from __future__ import annotations

import zipfile

import numpy as np
import pytest

from labial.corpus import read_corpus
from labial.corpus.corpora import read_avlaughter
from labial.corpus.folder import HEADER, read_frames
from labial.corpus.iemocap import align_head, read_iemocap
from labial.errors import DataError, LabialError
from labial.files.faps import FAP_NAMES

NAMES = (
    "CH1 CH2 CH3 FH1 FH2 FH3 LC1 LC2 LC3 LC4 LC5 LC6 LC7 LC8 RC1 RC2 RC3 RC4 RC5 RC6 RC7 RC8 LLID RLID MH MNOSE LNSTRL "
    "TNOSE RNSTRL LBM0 LBM1 LBM2 LBM3 RBM0 RBM1 RBM2 RBM3 LBRO1 LBRO2 LBRO3 LBRO4 RBRO1 RBRO2 RBRO3 RBRO4 Mou1 Mou2 "
    "Mou3 Mou4 Mou5 Mou6 Mou7 Mou8 LHD RHD"
).split()
#: Neutral face in mm: X to the subject's left, Y backwards, Z up. Nostrils 20 mm above the lips, mouth 50 mm wide.
FACE = {
    "Mou1": (-25, 15, -30), "Mou2": (-12, 5, -26), "Mou3": (0, 0, -25), "Mou4": (12, 5, -26), "Mou5": (25, 15, -30),
    "Mou6": (12, 6, -34), "Mou7": (0, 1, -35), "Mou8": (-12, 6, -34), "CH2": (0, 5, -60), "LNSTRL": (10, 5, -10),
    "RNSTRL": (-10, 5, -10), "TNOSE": (0, -10, 0), "MNOSE": (0, 0, 25), "MH": (0, 40, 110), "LHD": (70, 60, 90),
    "RHD": (-70, 60, 90), "FH1": (-30, 10, 70), "FH2": (0, 5, 72), "FH3": (30, 10, 70),
}  # fmt: skip
#: Marker, axis and millimetres that move each channel by 102.4 units: a tenth of 20 mm, or of 50 mm for the corners.
MOVES = {
    "open_jaw": ("CH2", 2, -2), "push_b_lip": ("Mou7", 1, -2), "push_t_lip": ("Mou3", 1, -2),
    "lower_t_midlip_o": ("Mou3", 2, -2), "raise_b_midlip_o": ("Mou7", 2, 2), "stretch_l_cornerlip_o": ("Mou5", 0, 5),
    "stretch_r_cornerlip_o": ("Mou1", 0, -5), "lower_t_lip_lm_o": ("Mou4", 2, -2), "lower_t_lip_rm_o": ("Mou2", 2, -2),
    "raise_b_lip_lm_o": ("Mou6", 2, 2), "raise_b_lip_rm_o": ("Mou8", 2, 2), "raise_l_cornerlip_o": ("Mou5", 2, 2),
    "raise_r_cornerlip_o": ("Mou1", 2, 2),
}  # fmt: skip
PHSEG = "SFrm EFrm SegAScr Phone\n0 99 -1 SIL\n100 149 -1 AA SIL B b\n150 199 -1 +BREATHING+\n Total score: -3\n"
STILL = np.arange(240) < 120


def face(moves, head=True):
    """(240, 55, 3) markers: silence and rest for a second, then the moves; all turned and shifted with the head."""
    markers = np.random.default_rng(1).normal(0, 50, (1, 55, 3)).repeat(240, axis=0)
    for name, place in FACE.items():
        markers[:, NAMES.index(name)] = place
    for name, axis, distance in moves:
        markers[~STILL, NAMES.index(name), axis] += distance
    if head:
        turn, nod = 0.2 * np.sin(np.arange(240) / 30), 0.15 * np.sin(np.arange(240) / 17)
        for t in range(240):
            z = [[np.cos(turn[t]), -np.sin(turn[t]), 0], [np.sin(turn[t]), np.cos(turn[t]), 0], [0, 0, 1]]
            x = [[1, 0, 0], [0, np.cos(nod[t]), -np.sin(nod[t])], [0, np.sin(nod[t]), np.cos(nod[t])]]
            markers[t] = markers[t] @ np.array(z) @ np.array(x) + [30 * turn[t], -20 * nod[t], 40 * turn[t]]
    return markers


def write(root, utterance, markers, phseg=PHSEG):
    """Writes an utterance where the corpus has it; the clock of its frames starts anywhere."""
    dialog = utterance.rpartition("_")[0]
    sentences = root / "Session1" / "sentences"
    motion, alignment = sentences / "MOCAP_rotated" / dialog, sentences / "ForcedAlignment" / dialog
    motion.mkdir(parents=True, exist_ok=True)
    alignment.mkdir(parents=True, exist_ok=True)
    lines = ["Frame# Time " + " ".join(NAMES), " ".join(f"X{i:02d} Y{i:02d} Z{i:02d}" for i in range(1, 56))]
    for t, frame in enumerate(markers):
        lines.append(f"{t + 500} {(t + 500) / 120:.5f} " + " ".join(f"{v:.5f}" for v in frame.ravel()))
    (motion / f"{utterance}.txt").write_text("\n".join(lines) + "\n")
    (alignment / f"{utterance}.phseg").write_text(phseg)
    return motion / f"{utterance}.txt"


@pytest.mark.parametrize("head", [False, True], ids=["still", "moving"])
@pytest.mark.parametrize("name", FAP_NAMES)
def test_each_move_has_its_channel_sign_and_size(tmp_path, name, head):
    """Catches swapped markers or sides, a wrong sign or unit, head motion that leaks into the lips."""
    write(tmp_path, "Ses01F_impro01_F000", face([MOVES[name]], head))
    (episode,) = read_iemocap(tmp_path)
    channel = FAP_NAMES.index(name)
    tolerance = 1.5 if head else 1e-2  # what the rotation of the reference face leaves, FAP units
    assert abs(episode.frames[STILL]).max() < tolerance
    assert abs(episode.frames[~STILL, channel] - 102.4).max() < tolerance
    assert abs(np.delete(episode.frames[~STILL], channel, axis=1)).max() < tolerance


def test_times_and_phonemes(tmp_path):
    """Catches the session's clock left in the times, and labels that are not phonemes."""
    write(tmp_path, "Ses01F_impro01_F000", face([]))
    (episode,) = read_corpus(tmp_path, "speech")
    assert episode.times[0] == 0 and abs(episode.times[-1] - 239 / 120) < 1e-4
    assert [(s.label, s.start, s.end) for s in episode.segments] == [("SIL", 0, 1), ("AA", 1, 1.5), ("SIL", 1.5, 2)]


def test_listeners_are_left_out(tmp_path):
    """Catches the listener's mouth being trained on the speaker's words."""
    for utterance in ("Ses01F_impro01_M000", "Ses01F_impro01_F001", "Ses01F_impro01_F000"):
        write(tmp_path, utterance, face([]))
    assert [e.name for e in read_iemocap(tmp_path)] == ["Ses01F_impro01_F000", "Ses01F_impro01_F001"]


def test_neutral_is_the_median_of_silence(tmp_path):
    """Catches a mean, which one open-mouthed breath in the silence would pull away."""
    markers = face([MOVES["open_jaw"]], head=False)
    markers[20:40, NAMES.index("CH2"), 2] -= 30
    write(tmp_path, "Ses01F_impro01_F000", markers)
    (episode,) = read_iemocap(tmp_path)
    assert abs(episode.frames[130, 0] - 102.4) < 0.01


def test_short_gaps_are_bridged_and_lost_head_markers_do_without(tmp_path):
    """Catches NaN that reaches the frames, and frames refused because one of the eight head markers is gone."""
    markers = face([MOVES["open_jaw"]])
    for begin, end, name in ((150, 170, "CH2"), (0, 5, "Mou3"), (60, 200, "LHD")):
        markers[begin:end, NAMES.index(name)] = np.nan
    write(tmp_path, "Ses01F_impro01_F000", markers)
    (episode,) = read_iemocap(tmp_path)
    assert np.isfinite(episode.frames).all() and abs(episode.frames[~STILL, 0] - 102.4).max() < 5


def test_alignment_neither_mirrors_nor_guesses():
    """Catches a mirrored face where three head markers leave the sign open, and a turn made up from two, or a line."""
    rng = np.random.default_rng(3)
    reference = np.concatenate([rng.normal(0, 50, (3, 3)), rng.normal(0, 50, (5, 3))])
    weights = np.array([1.0, 1, 1, 0, 0, 0, 0, 0])
    turns = np.linalg.qr(rng.normal(0, 1, (40, 3, 3)))[0]
    turns[:, :, 0] *= np.linalg.det(turns)[:, None]
    markers = np.einsum("mi,tij->tmj", reference, turns) + rng.normal(0, 30, (40, 1, 3))
    assert abs(align_head(markers, reference, weights) - reference).max() < 1e-6
    markers[:20, 1] = np.nan
    assert np.isnan(align_head(markers, reference, weights)[:20]).all()
    straight = reference.copy()
    straight[2] = 2 * straight[1] - straight[0]
    assert np.isnan(align_head(straight[None] + 5, straight, weights)).all()


@pytest.mark.parametrize("span", [(130, 160), (0, 30), (0, 240)], ids=["inside", "start", "all"])
def test_long_gaps_refuse_the_utterance_and_say_so(tmp_path, span):
    """Catches invented motion across long gaps, and utterances that vanish without a word."""
    write(tmp_path, "Ses01F_impro01_F000", face([]))
    bad = face([])
    bad[span[0] : span[1], NAMES.index("Mou7")] = np.nan
    path = write(tmp_path, "Ses01F_impro01_F001", bad)
    refused = []
    assert [e.name for e in read_iemocap(tmp_path, refused=refused)] == ["Ses01F_impro01_F000"]
    assert len(refused) == 1 and str(refused[0]).startswith(f"{path}: ")
    with pytest.warns(UserWarning, match="1 of 2 recordings were left out"):
        read_corpus(tmp_path, "speech")


def test_neutral_without_silence_is_the_closed_mouth(tmp_path):
    """Catches a neutral mouth that is an open one when the utterance has no pause."""
    phseg = "SFrm EFrm SegAScr Phone\n0 199 -1 AA\n Total score: -3\n"
    markers = face([MOVES["open_jaw"], ("Mou7", 2, -10)])
    markers[:120] = face([])[:120]
    write(tmp_path, "Ses01F_impro01_F000", markers, phseg)
    (episode,) = read_iemocap(tmp_path)
    assert abs(episode.frames[~STILL, 4] + 512).max() < 5 and abs(episode.frames[STILL]).max() < 5


@pytest.mark.parametrize("old, new, line", [
    ("Frame#", "Bild", 1), ("Mou3", "MOU3", 1), ("X01", "A01", 2), ("500 4.16667 ", "500 4.16667 1 ", 3),
    ("501 4.17500", "501 4.10000", 4), ("500 4.16667", "500 x", 3),
])  # fmt: skip
def test_malformed_motion_names_the_line(tmp_path, old, new, line):
    """Catches shifted columns, other spellings of markers, and clocks that run backwards."""
    path = write(tmp_path, "Ses01F_impro01_F000", face([]))
    path.write_text(path.read_text().replace(old, new, 1))
    with pytest.raises(DataError) as caught:
        read_iemocap(tmp_path)
    assert str(caught.value).startswith(f"{path}:{line}: ")


def test_other_axes_and_empty_folders_are_refused(tmp_path):
    """Catches mirrored data (left is right) and a wrong folder."""
    with pytest.raises(DataError, match="no usable utterance"):
        read_iemocap(tmp_path)
    write(tmp_path, "Ses01F_impro01_F000", face([], head=False) * [-1, 1, 1])
    with pytest.raises(DataError, match="subject's left"):
        read_iemocap(tmp_path)


# ---- AVLaughterCycle -------------------------------------------------------------------------------------------------


def grid(*tiers):
    """A short TextGrid of tiers of (start, end, label)."""
    head = ['File type = "ooTextFile"', 'Object class = "TextGrid"', "", "0", "2", "<exists>", str(len(tiers))]
    for number, tier in enumerate(tiers):
        head += ['"IntervalTier"', f'"tier{number}"', "0", "2", str(len(tier))]
        for start, end, label in tier:
            head += [str(start), str(end), f'"{label}"']
    return "\n".join(head) + "\n"


SYMBOLS = [(0, 0.5, "silence"), (0.5, 0.6, "h"), (0.6, 0.7, r"\as"), (0.7, 0.8, r"\ic\O^"), (0.8, 1.2, ""),
           (1.2, 1.4, "ne?"), (1.4, 1.6, "vocal_fry"), (1.6, 2, "")]  # fmt: skip
AIR = [(0, 0.5, ""), (0.5, 0.8, "e"), (0.8, 1.2, "i"), (1.2, 1.6, "e"), (1.6, 2, "")]


def write_laugh(folder, name, text, motion=True):
    """Writes a laugh."""
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.TextGrid").write_text(text)
    if motion:
        rows = "".join(f"{i * 0.02:.2f}{',0' * 13}\n" for i in range(100))
        (folder / f"{name}.csv").write_text(HEADER + "\n" + rows)


def test_symbols_become_laughter_phonemes_and_airflow_fills_in(tmp_path):
    """Catches tier 2 read as phonemes, an unheard inhalation, an unlabelled end that is lost."""
    write_laugh(tmp_path / "s1", "6_100_2100", grid(SYMBOLS, AIR))
    (episode,) = read_corpus(tmp_path, "laughter")
    assert episode.name == "6_100_2100" and episode.frames.shape == (100, 13)
    assert " ".join(s.label for s in episode.segments) == "silence fricative a cackle ne ne grunt silence"
    assert episode.segments[-1].end == 2


def test_speech_and_lack_of_motion_are_left_out_and_reported(tmp_path):
    """Catches words trained as laughter, and laughs that vanish without a word."""
    write_laugh(tmp_path, "1_0_2000", grid(SYMBOLS))
    write_laugh(tmp_path, "6_647700_650800", grid(SYMBOLS, [(0, 2, "speech")]))
    write_laugh(tmp_path, "2_0_2000", grid(SYMBOLS), motion=False)
    write_laugh(tmp_path, "notes", "not a laugh", motion=False)
    refused = []
    assert [e.name for e in read_avlaughter(tmp_path, refused=refused)] == ["1_0_2000"]
    assert [str(r).endswith("contains speech") for r in refused] == [False, True]


def test_faults_name_the_file(tmp_path):
    """Catches unknown symbols that become silence, motion without annotation, an empty corpus."""
    with pytest.raises(DataError, match="no usable laugh"):
        read_avlaughter(tmp_path)
    write_laugh(tmp_path, "1_0_2000", grid([(0, 1, "a"), (1, 2, "%%")]))
    with pytest.raises(DataError, match=r"1_0_2000.TextGrid: interval 2: no laughter phoneme"):
        read_avlaughter(tmp_path)
    (tmp_path / "1_0_2000.TextGrid").rename(tmp_path / "1_0_2001.TextGrid")
    with pytest.raises(DataError, match=r"1_0_2000.csv: no 1_0_2000.TextGrid"):
        read_avlaughter(tmp_path)


# ---- The Labial corpus folder ----------------------------------------------------------------------------------------


ROW = ",1" * 13


def frames(count=10, step=0.1):
    """Text of a frames file."""
    return HEADER + "\n" + "".join(f"{i * step:.2f}{ROW}\n" for i in range(count))


def fill(folder, names):
    """Writes pairs of files."""
    for name in names:
        (folder / f"{name}.csv").write_text(frames())
        (folder / f"{name}.lab").write_text("0 0.5 HH\n0.5 0.9 AH0\n")


def fails(call, start, words=""):
    """Asserts a DataError whose message begins with `start`."""
    with pytest.raises(DataError) as caught:
        call()
    assert str(caught.value).startswith(f"{start}: ") and words in str(caught.value)


def test_episodes_are_sorted_and_strangers_ignored(tmp_path):
    """Catches an order that depends on the file system, and a README taken for data."""
    fill(tmp_path, ["b", "a", "c.1"])
    (tmp_path / "README.md").write_text("x")
    (tmp_path / "._a.csv").write_text("x")
    episodes = read_corpus(tmp_path, "speech")
    assert [e.name for e in episodes] == ["a", "b", "c.1"]
    assert episodes[0].frames.shape == (10, 13) and episodes[0].times.shape == (10,)
    assert [s.label for s in episodes[0].segments] == ["HH", "AH"]


@pytest.mark.parametrize(("name", "text", "start", "words"), [
    ("a.csv", None, "a.lab", "a.csv"), ("a.lab", None, "a.csv", "a.lab"), ("a.TextGrid", "x", "a.lab", "a.TextGrid"),
    # Timings in milliseconds or of another episode, which would train on a held mouth; motion in milliseconds.
    ("a.lab", "0 0.5 HH\n0.5 90 AH0\n", "a.lab", "motion"), ("a.csv", frames(step=100), "a.csv", "times in seconds?"),
    ("a.csv", frames().rstrip("\n")[:-1] + "99999\n", "a.csv:11", "beyond 10000 FAP units"),
])  # fmt: skip
def test_files_that_do_not_go_together(tmp_path, name, text, start, words):
    """Catches episodes that vanish because one of their files is missing, a silent choice between two timings, an error
    that names the other file, or none after a training."""
    fill(tmp_path, ["a", "b"])
    (tmp_path / name).unlink() if text is None else (tmp_path / name).write_text(text)
    fails(lambda: read_corpus(tmp_path), tmp_path / start, words)


def test_folders_that_are_no_corpus(tmp_path):
    fails(lambda: read_corpus(tmp_path), tmp_path, "no episodes")
    fails(lambda: read_corpus(tmp_path / "x"), tmp_path / "x", "no such folder")
    fill(tmp_path, ["a"])
    with pytest.raises(LabialError):
        read_corpus(tmp_path, "song")


@pytest.mark.parametrize("text, line", [
    ("", 1), (frames().replace("fap16", "fap61"), 1), (frames().replace("fap16,fap17", "fap17,fap16"), 1),
    (HEADER + "\n0" + ROW + "\n0.1" + ROW[:-2] + "\n", 3), (HEADER + "\n0" + ROW + ",1\n", 2),
    (HEADER + "\n0" + ROW + "\n0" + ROW + "\n", 3), (HEADER + "\n0" + ROW[:-1] + "nan\n", 2),
    (HEADER + "\n0" + ROW[:-1] + "\n", 2), (HEADER + "\n0" + ROW + "\n\n.1" + ROW + "\n", 3), (HEADER + "\n", None),
])  # fmt: skip
def test_malformed_frames_name_the_line(tmp_path, text, line):
    """Catches swapped or missing columns, ragged rows, time that stands still, and values that are not numbers."""
    path = tmp_path / "a.csv"
    path.write_text(text)
    fails(lambda: read_frames(path), f"{path}:{line}" if line else path)


def test_the_tier_of_an_unknown_label_is_named(tmp_path):
    """Catches words that are read for phonemes, with an error that does not say where they are from."""
    fill(tmp_path, ["a"])
    (tmp_path / "a.lab").unlink()
    (tmp_path / "a.TextGrid").write_text(grid([(0, 0.5, ""), (0.5, 1, "hello")]))
    fails(lambda: read_corpus(tmp_path), f"{tmp_path / 'a.TextGrid'}:18", "called 'hello' (tier 'tier0')")


def packed(folder, names=None):
    """Moves files of a folder into a zip file there."""
    archive = folder / "episodes.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
        for path in sorted(folder.iterdir()):
            if path != archive and (names is None or path.name in names):
                out.write(path, path.name)
                path.unlink()
    return archive


def test_packed_episodes_are_read_as_they_are(tmp_path):
    """Whole corpora and parts of one; would catch another order, names that are not the files' own."""
    fill(tmp_path, ["c", "a", "b"])
    loose = read_corpus(tmp_path)
    packed(tmp_path, ["a.csv", "a.lab", "c.csv"])
    for rest in (["b.csv", "b.lab", "c.lab"], []):
        found = read_corpus(tmp_path)
        assert [item.name for item in found] == ["a", "b", "c"]
        for one, other in zip(found, loose):
            assert one.segments == other.segments and np.array_equal(one.frames, other.frames)
        (tmp_path / "episodes.zip").rename(tmp_path / f"{len(rest)}.ZIP")
        packed(tmp_path, rest)


def test_errors_of_packed_files_name_archive_file_and_line(tmp_path):
    fill(tmp_path, ["a"])
    (tmp_path / "a.csv").write_text(HEADER + "\n0" + ROW + "\n1,2\n")
    archive = packed(tmp_path)
    fails(lambda: read_corpus(tmp_path), f"{archive}/a.csv:3", "2 columns")
    fill(tmp_path, ["a"])
    fails(lambda: read_corpus(tmp_path), f"{archive}/a.csv", "there is also a.csv")


def test_archives_that_cannot_be_read(tmp_path, monkeypatch):
    """Damaged, no archive at all, too large unpacked; what lies in folders of an archive is not looked at."""
    fill(tmp_path, ["a"])
    archive = packed(tmp_path)
    with zipfile.ZipFile(archive, "a") as out:
        out.writestr("folder/a.csv", "nothing")
        out.writestr(".hidden.csv", "nothing")
        out.writestr("README.md", "nothing")
    assert len(read_corpus(tmp_path)) == 1
    monkeypatch.setattr("labial.files.limits.CORPUS", 100)
    fails(lambda: read_corpus(tmp_path), archive, "more than the 100 that are read")
    monkeypatch.undo()
    archive.write_bytes(archive.read_bytes()[:200])
    fails(lambda: read_corpus(tmp_path), archive, "damaged")
