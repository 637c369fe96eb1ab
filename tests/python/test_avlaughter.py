"""AVLaughterCycle: symbols of tier 1, airflow of tier 2, motion that was converted beforehand."""

from __future__ import annotations

import pytest

from labial.corpus import read_corpus
from labial.corpus.avlaughter import read_avlaughter
from labial.corpus.folder import HEADER
from labial.errors import DataError


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


def write(folder, name, text, motion=True):
    """Writes a laugh."""
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.TextGrid").write_text(text)
    if motion:
        rows = "".join(f"{i * 0.02:.2f}{',0' * 13}\n" for i in range(100))
        (folder / f"{name}.csv").write_text(HEADER + "\n" + rows)


def test_symbols_become_laughter_phonemes_and_airflow_fills_in(tmp_path):
    """Catches tier 2 read as phonemes, an unheard inhalation, an unlabelled end that is lost."""
    write(tmp_path / "s1", "6_100_2100", grid(SYMBOLS, AIR))
    (episode,) = read_corpus(tmp_path, "laughter")
    assert episode.name == "6_100_2100" and episode.frames.shape == (100, 13)
    assert " ".join(s.label for s in episode.segments) == "silence fricative a cackle ne ne grunt silence"
    assert episode.segments[-1].end == 2


def test_speech_and_lack_of_motion_are_left_out_and_reported(tmp_path):
    """Catches words trained as laughter, and laughs that vanish without a word."""
    write(tmp_path, "1_0_2000", grid(SYMBOLS))
    write(tmp_path, "6_647700_650800", grid(SYMBOLS, [(0, 2, "speech")]))
    write(tmp_path, "2_0_2000", grid(SYMBOLS), motion=False)
    write(tmp_path, "notes", "not a laugh", motion=False)
    refused = []
    assert [e.name for e in read_avlaughter(tmp_path, refused=refused)] == ["1_0_2000"]
    assert [str(r).endswith("contains speech") for r in refused] == [False, True]


def test_faults_name_the_file(tmp_path):
    """Catches unknown symbols that become silence, motion without annotation, an empty corpus."""
    with pytest.raises(DataError, match="no usable laugh"):
        read_avlaughter(tmp_path)
    write(tmp_path, "1_0_2000", grid([(0, 1, "a"), (1, 2, "%%")]))
    with pytest.raises(DataError, match=r"1_0_2000.TextGrid: interval 2: no laughter phoneme"):
        read_avlaughter(tmp_path)
    (tmp_path / "1_0_2000.TextGrid").rename(tmp_path / "1_0_2001.TextGrid")
    with pytest.raises(DataError, match=r"1_0_2000.csv: no 1_0_2000.TextGrid"):
        read_avlaughter(tmp_path)
