"""The figures of the pages: for each page its sentences, and where their figures come from.

To add one, write the sentence as the page has it, `{}` in the place of each figure, and the figures' sources and
formats. `python3 bench/figures.py` then writes them. A figure that has no source here belongs into no page, unless the
page says when it was measured.
"""

from __future__ import annotations

from pathlib import Path
from statistics import fmean
from typing import Callable, Dict, Iterator, List, Sequence, Tuple

from measure import baseline, records
from measure.boards import BOARDS
from measure.core import Figure
from measure.pages import Sentence, count, decimal, lines, row, sentence, share, word
from measure.sizes import BESIDE
from measure.sources import Sources, Table, Talkers, mean_and_error, number

#: Columns of the boards' tables, and the host's.
TARGETS = [board.preset for board in BOARDS]
#: Sections of RESULTS.md, and their tables in order.
TALKERS, RANDOM, UNSEEN = "Talkers left out", "Random splits", "Unseen words"
LAUGHTER, HEARD = "Laughter: synthetic data", "Lips from sound"
DIFF, OTHER = 0, 1  #: Table 1 and Table 2 of a report
LEFT_OUT, ALONE, ON_ONE, ON_ONE_OTHER = 0, 1, 2, 3  #: tables of TALKERS

DEVICE, FLOAT, PAPER, NORMALISED = "Labial, device", "Labial, float64", "paper", "paper, normalised features"
#: Methods of RESULTS.md whose name in other tables is longer.
BLUR, MEAN, DOMINANCE, REGRESSION = ("steps + Gaussian blur", "mean shape", "Cohen-Massaro dominance",
                                     "linear regression")
HMM = "HMM synthesis"
PARAMETERS = ("openness", "extension", "top", "bottom")


def of(root: Path, measured: Sequence[Figure] = ()) -> Dict[str, List[Sentence]]:
    """The sentences of each page, by its path below `root`, with the figures of bench/baseline.json, or those that were
    `measured` just now."""
    source = Sources(root, baseline.read(root / "bench" / "baseline.json"), measured, records.read(root))
    return {name: list(listed(source)) for name, listed in PAGES.items()}


def _talkers(source: Sources) -> Dict[str, Talkers]:
    left_out = source.results.table(TALKERS, LEFT_OUT)
    return {"voice": Talkers(left_out, DEVICE), "paper": Talkers(left_out, PAPER),
            "method": Talkers(source.results.table(TALKERS, ALONE), DEVICE)}


def _cell(text: str, digits: int = 2) -> str:
    return share(number(text), digits)


def _kilobytes(value: float, digits: int = 0) -> str:
    return decimal(value / 1000, digits)


def readme(source: Sources) -> Iterator[Sentence]:
    bench = source.bench
    diff, other = source.results.table(RANDOM, DIFF), source.results.table(RANDOM, OTHER)
    voice = source.results.table(TALKERS, ON_ONE_OTHER)
    talkers = _talkers(source)
    ram, code, model = bench("speech: workspace and labial_t"), bench("code -Os: total"), bench("speech: model")
    busy = bench("speech: share of the core")
    yield sentence("| memory | {} KB of RAM; {} KB of flash with an English voice |", _kilobytes(ram, 1),
                   _kilobytes(code + model, 1))
    yield sentence("| time | {} % of a Cortex-M0 at 16 MHz", decimal(busy, 1))
    yield sentence("| motion, bundled voice | correlation {} ± {} with the mouths of talkers who were left out of its "
                   "training; the published method¹ has {} ± {} |", *talkers["voice"].cells()[3:],
                   *talkers["paper"].cells()[3:])
    yield sentence("| motion, method alone | mean error {} of the largest value on new sentences of the one talker "
                   "that it learnt; the published method¹ has {} |", _cell(diff[DEVICE]["mean"], 3),
                   _cell(diff[PAPER]["mean"], 3))
    yield sentence("| closed lips | in {} % of p, b, m; people close them in {} % |",
                   100 * number(voice[DEVICE]["closure"]), 100 * number(other["human"]["closure"]))


def costs(source: Sources) -> Iterator[Sentence]:
    bench = source.bench
    diff, other = source.results.table(RANDOM, DIFF), source.results.table(RANDOM, OTHER)
    unseen = source.results.table(UNSEEN, DIFF)
    voice_diff, voice = source.results.table(TALKERS, ON_ONE), source.results.table(TALKERS, ON_ONE_OTHER)
    talkers = _talkers(source)
    ram = bench("speech: workspace and labial_t")
    yield sentence("| code | {} | enough to play compiled-in models, `-Os`; the compiler adds {} of its own",
                   bench("code -Os: total"), bench("code -Os: compiler's helpers"))
    yield sentence("| speech model | {} |", bench("speech: model"))
    yield sentence("| laughter model | {} |", bench("laughter: model"))
    yield sentence("| RAM | {} | stream {}, workspace {};", ram, bench("labial_t"), bench("speech: workspace"))
    yield sentence("| stack | {} | at most; {} with `-O2` |", bench("stack -Os: all of lib"),
                   bench("stack -O2: all of lib"))
    words = sum(bench(f"code -Os: {name}.c") for name in _WORDS)
    yield sentence("rig {}; laughs {}; speaking while laughing {}; names {} and speech's {}; binary models {}; words "
                   "{} and their tables {} |",
                   *(bench(f"code -Os: {name}.c") for name in ("rig", "laugh", "blend", "names")),
                   bench("speech: names"), bench("code -Os: blob.c") + bench("code -Os: model.c"), words,
                   bench("words: tables"))
    yield sentence("| npm package | {} | compressed, fetched by a page that speaks; {} more when it laughs; {} more "
                   "for words;", *(bench(figure, "wasm") for figure in _NPM[:3]))
    for model_name in ("speech", "laughter"):
        means = [bench(f"{model_name}: mean", target) for target in (*TARGETS, "host")]
        yield row(f"{model_name}, mean", *means)
    worst = [decimal(bench("speech: worst tick / mean", target), 2) for target in TARGETS]
    yield row("worst tick, times the mean", *worst)
    yield sentence("| share of the core at 50 frames/s, speech | {} % | {} % | {} % |",
                   *(decimal(bench("speech: share of the core", target), 1) for target in TARGETS[:3]))
    yield sentence("The Cortex-M0 takes {} cycles for the {} instructions", round(bench("speech: cycles"), -2),
                   bench("speech: mean"))

    yield sentence("| | two who speak freely | {} labels, who say commands | all {} |",
                   word(len(talkers["voice"].of(False))), word(len(talkers["voice"].each)))
    for name, title in (("paper", "published method¹, trained on s1"), ("method", "Labial, trained on s1"),
                        ("voice", "**Labial, trained on all others: the bundled voice**")):
        yield sentence(f"| {title} | {{}} | {{}} ± {{}} | {{}} ± {{}} |", *talkers[name].cells())
        nearer = [talkers["voice"].each[talker] > value for talker, value in talkers["method"].each.items()]
    yield sentence("it comes closer than the method to {} of the {} others", word(sum(nearer)), word(len(nearer)))
    for title, method in (("published method¹", PAPER), ("its steps, blurred", BLUR), (DOMINANCE, DOMINANCE),
                          ("HMM synthesis (triphones)", HMM), ("**Labial, trained on s1**", DEVICE)):
        yield row(title, *_closeness(diff[method], other[method], unseen[method]))
    yield sentence("| **Labial, the bundled voice** | {} | | {} | {} | {} |",
                   *_closeness(voice_diff[DEVICE], voice[DEVICE]))
    yield sentence("| human | 0 | 0 | 1 | 1 | {} |", _cell(other["human"]["closure"]))


def _closeness(diff: Dict[str, str], other: Dict[str, str], *unseen: Dict[str, str]) -> List[str]:
    """Cells of the last table of docs/figures.md."""
    closed = number(other["closure"])
    return [*(_cell(one["mean"], 3) for one in (diff, *unseen)), _cell(other["correlation"]),
            _cell(other["amplitude"]), share(closed) if closed < 1 else decimal(closed, 2)]


#: The files of labial/words.h.
_WORDS = ("words", "words_characters", "words_dates", "words_letters", "words_numbers", "words_text", "words_time")
#: The files of labial/voice.h.
_VOICE = ("voice", "voice_frames", "voice_items", "voice_messages", "voice_plan", "voice_words")
#: What pages fetch from npm, compressed, in bench/baseline.json.
_NPM = ("a page that speaks, each script compressed", "laughter, compressed", "words, each script compressed",
        "hearing by the small model, each script compressed", "hearing by the large model, each script compressed")
#: The states in DESIGN.md's table of modules: what it says of their parts, and of RAM beside the state.
_STATES = {"labial_t": ("", " + workspace"),
           "labial_hear_t": (": features, network, convert, motion, fade", " + workspace"),
           "labial_words_t": ("", ""), "labial_laugh_t": ("", ""), "labial_timings_t": ("", ""),
           "labial_voice_t": (": items, plan, stream", " + workspace + 16 for each item"),
           "labial_beside_t": ("", " + ring"), "labial_face_t": ("", " + ring"), "labial_clock_t": ("", "")}


def design(source: Sources) -> Iterator[Sentence]:
    bench, closures = source.bench, source.record("closures")
    yield sentence("In contact the outer lips are at most {} FAP units apart, in all of {} p, b, m of eight voices",
                   closures["stops: most"], closures["stops"])
    yield sentence("Of {} f, v they are {} or more apart in half and {} or more in 95 %", closures["f, v"],
                   closures["f, v: half"], closures["f, v: 95 %"])
    yield sentence("the model has {} bytes;", bench("laughter: model"))
    yield sentence("every three frames: {} on a Cortex-M0, {} on an M4F, {} on x86-64, where hts_engine takes {} for "
                   "whole units", *(bench("MLPG", target) for target in ("m0", "m4", "host")),
                   bench("MLPG by hts_engine", "host"))
    yield sentence("A whole tick takes {} instructions on a Cortex-M0; of these the search takes {}, equation 3 {} and "
                   "the targets {}", *(round(value, -2) for value in (bench("speech: mean"), bench("speech: viterbi.c"),
                   bench("speech: trajectory.c"), bench("speech: shape.c"))))
    yield sentence("`LABIAL_WINDOW` = {} frames ahead", source.limit("LABIAL_WINDOW"))
    for state, (parts, more) in _STATES.items():
        yield sentence(f"`{state}`{parts} | {{}}{more} |", bench(state))
    streams = (source.root / "tests" / "conformance" / "streams.txt").read_text(encoding="utf-8")
    yield sentence("| every target | {} conformance streams", streams.count("\nstream "))


def method(source: Sources) -> Iterator[Sentence]:
    search, pictured = source.record("search"), source.record("side by side")
    for limits in dict.fromkeys(key.rsplit(" ", 1)[0] for key in search):
        lag, width = limits.split()
        yield row(f"{lag} | {width}", decimal(search[f"{limits} states"], 2), decimal(search[f"{limits} motion"], 2))
    yield sentence("In the {} p, b, m the published method leaves the lips {} to {} FAP units apart, Labial {} to {},",
                   word(int(pictured["speech_en count"])),
                   *(pictured[f"{who} {end}"] for who in ("paper", "speech_en") for end in ("least", "most")))
    for title, letter, figure in (("instructions, mean per frame", "262,521", "speech: mean"),
                                  ("instructions, longest tick", "5,902,301", "speech: worst tick"),
                                  ("workspace, bytes", "4,960", "speech: workspace"),
                                  ("stack, bytes", "1,248", "stack -Os: all of lib")):
        yield sentence(f"| {title} | {letter} | {{}} |", source.bench(figure))
    for name in ("LAG", "SEARCHED"):
        yield sentence(f"`LABIAL_{name}` (default {{}})", source.limit(f"LABIAL_{name}"))


def reproduction(source: Sources) -> Iterator[Sentence]:
    split = source.record("first split")
    for title in dict.fromkeys(key.split(": ")[0] for key in split):
        values = [(name, split.get(f"{title}: {name}")) for name in
                  ("diff", "correlation", "amplitude", "closure", "jitter", "seam")]
        shown = [decimal(value, 4 if name == "diff" else 3) for name, value in values if value is not None]
        yield Sentence(f"| {title} |" + "".join(" {} |" if value is not None else " - |" for _, value in values),
                       tuple(shown))
    speech, laughter = source.results.table(RANDOM, DIFF), source.results.table(LAUGHTER, DIFF)

    def cells(made: Dict[str, str]) -> List[str]:
        return [made[name].split(" ")[0] for name in PARAMETERS]

    for table, end, methods in (
        (speech, "GRID", (("the paper's method, here", PAPER), ("the same, normalised features", NORMALISED),
                          ("HMM synthesis, here", HMM), ("its steps, blurred, here", BLUR),
                          ("a motionless mean shape, here", MEAN), (DEVICE, DEVICE))),
        (laughter, "synthetic laughs", (("the paper's method, here", PAPER),
                                        ("the same, normalised features", NORMALISED),
                                        ("linear regression, here", REGRESSION), ("HMM synthesis, here", HMM),
                                        ("Cohen-Massaro dominance, here", DOMINANCE), (DEVICE, DEVICE)))):
        for title, made in methods:
            yield sentence(f"| {title} | {{}} | {{}} | {{}} | {{}} | {end} |", *cells(table[made]))
    unseen = source.results.table(UNSEEN, DIFF)

    def mean(table: Table, made: str) -> str:
        return _cell(table[made]["mean"], 4)

    yield sentence("On GRID, HMM synthesis is far better than the published method ({} against {} in the mean of the "
                   "four parameters), and it is better on unseen words too ({} against {}).",
                   *(mean(table, made) for table in (speech, unseen) for made in (HMM, PAPER)))
    yield sentence("linear regression is better than the published method ({} against {})", mean(laughter, REGRESSION),
                   mean(laughter, PAPER))
    yield sentence("gives less error than searching and solving ({} against {})", mean(speech, BLUR),
                   mean(speech, PAPER))


def python(source: Sources) -> Iterator[Sentence]:
    yield sentence("The library has {} KB with all models and names", _kilobytes(
        source.bench("shared library with both models", "python")))


def porting(source: Sources) -> Iterator[Sentence]:
    size = source.workspace
    for name in ("WINDOW", "LAG", "SEARCHED", "QUEUE", "REACH", "MODELS"):
        yield sentence(f"| `LABIAL_{name}` | {{}} |", source.limit(f"LABIAL_{name}"))
    window, lag, searched = (source.limit(f"LABIAL_{name}") for name in ("WINDOW", "LAG", "SEARCHED"))
    usual = size()
    yield sentence("solved ahead of the delivered frame | a frame of delay, {} bytes of workspace",
                   size(LABIAL_WINDOW=window + 1) - usual)
    yield sentence("decides a state | a frame of delay, {} bytes of workspace for the first, {} for nine",
                   size(LABIAL_LAG=lag + 1) - usual, size(LABIAL_LAG=lag + 9) - usual)
    more = size(LABIAL_SEARCHED=searched + 8) - usual
    with_lag = size(LABIAL_SEARCHED=searched + 8, LABIAL_LAG=lag + 1) - size(LABIAL_LAG=lag + 1)
    yield sentence("a step of the search considers | {} bytes of workspace, {} more for each frame of the lag",
                   more / 8, (with_lag - more) / 8)
    yield sentence("With `LABIAL_WINDOW` 1 a frame comes after 80 ms, and the workspace has {} bytes instead of {}.",
                   size(LABIAL_WINDOW=1), usual)
    found = source.record("window")
    yield sentence("on the 32 sentences of `sentences.flite`, {} seconds:", found["seconds"])
    yield sentence("correlation {} .. {}, mean {}; difference up to {} of a FAP's standard deviation",
                   *(decimal(found[name], 4) for name in ("least", "most", "mean")), decimal(found["difference"], 3))


def packages(source: Sources) -> Iterator[Sentence]:
    major, minor = (source.constant("include/labial/labial.h", f"LABIAL_VERSION_{part}") for part in ("MAJOR", "MINOR"))
    yield sentence("`find_package(labial {})` accepts any {}, but not {}.",
                   *(f"{major}.{number}" for number in (minor, minor, minor + 1)))


def esp32_hear(source: Sources) -> Iterator[Sentence]:
    own, heard = source.bench("esp32-hear, lips.c: flash", "m4"), source.bench("hear_small: flash", "m4")
    clock = source.bench("code -Os: clock.c", "m4")
    yield sentence("| RAM: stream, workspace of `hear_small`, 64 waiting frames | {} |",
                   source.bench("esp32-hear, lips.c: RAM", "m4"))
    yield sentence("| flash: `lips.c` {}, the library's clock {}, its hearing with `hear_small` {} | {} |", own, clock,
                   heard, own + clock + heard)
    for text in ("when it has the {} ms of sound from the frame's begin on",
                 "A frame needs the {} ms of sound after its begin", "holds less than {} ms, the lips are late",
                 "task of its own writes it to I2S, {} ms later.", "**The answer comes {} ms later**"):
        yield sentence(text, source.latency())


def beside(source: Sources) -> Iterator[Sentence]:
    own, heard = source.bench("esp32-hear, lips.c: flash", "m4"), source.bench("hear_small: flash", "m4")
    yield sentence("only a player of {} KB of code", _kilobytes(source.bench("code -Os: beside.c"), 1))
    yield sentence("| hears the sound that it plays ([esp32-hear.md](esp32-hear.md)) | {} KB | {} KB | {} ms of sound "
                   "ahead |", _kilobytes(own + heard), _kilobytes(source.bench("esp32-hear, lips.c: RAM", "m4"), 1),
                   source.latency())
    yield sentence("| flash, bytes | {}, and 266 for a division of 32 bits | {} | {}, and divisions |",
                   *(source.bench("code -Os: beside.c", target) for target in ("m0", "m4", "uno")))
    yield sentence("| RAM, bytes, 128 frames ahead | {} | {} | {} |",
                   *(source.bench(BESIDE, target) for target in ("m0", "m4", "uno")))
    yield sentence("and the library's clock {};", source.bench("code -Os: clock.c", "m4"))


def hearing(source: Sources) -> Iterator[Sentence]:
    for text in ("when the network has heard what follows, {} ms", "If the player has {} ms or more in its buffer",
                 "otherwise its last {} ms have no frames", "the lips are {} ms late, or the sound has to wait"):
        yield sentence(text, source.latency())
    for model in ("hear_small", "hear_large"):
        worst = [source.bench(f"{model}, 16000 Hz: worst frame", target) for target in TARGETS]
        worst += [source.bench(f"{model}, {rate} Hz: worst frame", "m4") for rate in (24000, 48000)]
        yield row(f"`{model}`", *(source.bench(f"{model}: {what}", "m4") for what in ("flash", "RAM")),
                  *(round(value, -3) for value in worst))
    for group, method, cells in _real_lips(source, ("opening", "upper lip", "corners", "mean of five")):
        yield row(f"{group} | {method}", *cells)
    heard = _by_sound(source)
    for title, sounds in _SOUNDS.items():
        libraries = ("integers", "wawa-lipsync", "wawa-lipsync unsmoothed", "headaudio", "pocketsphinx")
        cells = [figure for method in libraries for figure in heard[sounds, method]]
        yield sentence(f"| {title} |" + " {} / {} / {} |" * len(libraries), *cells)


#: Titles of sounds in docs/hearing.md, and their names in RESULTS.md.
_SOUNDS = {"125 people (169 clips)": "talkers/judge", "flite's awb": "flite:awb",
           "espeak-ng's klatt4": "espeak:en-us+klatt4", "espeak-ng's f5": "espeak:en-us+f5",
           "espeak-ng's Jacky": "espeak:en-us+Jacky"}
#: Groups of real lips and their names in the pages; methods, and the records that have them.
_GROUPS = {"grid_singles+grid_more": "GRID", "addresses": "addresses"}
_LIPS = {"`hear_ahead`": ("hear_ahead", "integers"), "`hear_host`": ("hear_host", "integers"),
         "`hear_large`": ("hear_large", "integers"), "`hear_small`": ("hear_small", "integers"),
         "loudness": ("hear_large", "loudness"), "phonemes, known": ("hear_large", "phonemes"),
         "phonemes with 30 % of `hear_host`": ("hear_host", "phonemes and sound")}


def _real_lips(source: Sources, heads: Sequence[str]) -> Iterator[Tuple[str, str, List[str]]]:
    """Group, method and correlations of each row of a table of real lips."""
    for name, group in _GROUPS.items():
        for method, (model, kind) in _LIPS.items():
            record = source.record(f"real lips, {model}")
            yield group, method, [share(record[f"{name} {kind}: {head}"], 3) for head in heads]


def _by_sound(source: Sources) -> Dict[Tuple[str, str], List[str]]:
    """The three figures of docs/hearing.md by sounds and method."""
    found = {}
    for line in source.results.rows(HEARD):
        digits = ((line["opening"], 3), (line["p, b, m closed"], 2), (line["false closures per second"], 2))
        found[line["sounds"], line["method"]] = [share(float(value), places) for value, places in digits]
    return found


def words(source: Sources) -> Iterator[Sentence]:
    bench = source.bench
    code = sum(bench(f"code -Os: {name}.c") for name in _WORDS)
    yield sentence("{} KB of code and {} KB of tables in flash, 1 KB of RAM for a stream of words and {} bytes of "
                   "stack", _kilobytes(code, 1), _kilobytes(bench("words: tables")), bench("stack -Os: words.h"))
    yield sentence("A page fetches {} KB for it, compressed, when it asks for words",
                   _kilobytes(bench(_NPM[2], "wasm")))
    for what in ("read", "say"):
        cells = [bench(f"words: {kind} to {what} one", target) for target in TARGETS
                 for kind in ("mean", "worst")]
        yield sentence(f"| to {what} |" + " {} / {} |" * len(TARGETS), *cells)


def browser(source: Sources) -> Iterator[Sentence]:
    speech, laughter, timed, small, large = (source.bench(figure, "wasm") for figure in _NPM)
    yield sentence("A page that speaks fetches {} KB, compressed; a page that laughs fetches {} KB more",
                   _kilobytes(speech), _kilobytes(laughter))
    yield sentence("the package `labial-words`, {} KB,", _kilobytes(timed))
    yield sentence("the package `labial-hearing`, {} KB.", _kilobytes(small))
    yield sentence("a page fetches {} KB more |", _kilobytes(large - small))


def servos(source: Sources) -> Iterator[Sentence]:
    found, other = source.record("closures"), source.record("closures of awb")
    yield sentence("a jaw that only followed them would stop {} us short of 1400 in the median *p, b, m*, and reach it "
                   "in {} %.", found["short"], found["reach"])
    yield sentence("the share of {} *p, b, m* within 10 us of `closed`, in {} sentences by each of eight voices",
                   found["stops"], found["sentences"] / len(records.VOICES))

    def cell(slew: str, acceleration: str, sight: str) -> List[str]:
        closed, opening = (found[f"{slew} {acceleration} {sight}: {what}"] for what in ("closed", "opening"))
        return [share(closed) if closed < 0.995 else "1.00", share(opening) if opening < 0.995 else "1.00"]

    limits = list(dict.fromkeys(key.rsplit(" ", 2)[0] for key in found if key.endswith(": closed")))
    for pair in limits:
        slew, acceleration = pair.split()
        sights = ("1", "32") if pair == "- -" else ("1", "6", "10", "32")
        cells = [figure for sight in sights for figure in cell(slew, acceleration, sight)]
        head = " | ".join("none" if part == "-" else part for part in (slew, acceleration))
        empty = " | |" if pair == "- -" else ""
        yield sentence(f"| {head} | {{}} ({{}}) |{empty}" + " {} ({}) |" * (len(sights) - 1), *cells)
    yield sentence("The code of `face.c` that such a program links has {} KB on a Cortex-M0, and with what it needs of "
                   "`rig.c` {} KB;", *(_kilobytes(source.bench(f"code -Os: a face, {what}"), 1) for what in
                   ("of face.c", "with rig.c and fixed.c")))
    baked = [other[f"{pair} 32: closed"] for pair in limits]
    yield sentence("Of {} *p, b, m* of flite's voice awb, `labial bake` closes at least {} % at each of these limits",
                   other["stops"], 100 * min(baked))


def arduino(source: Sources) -> Iterator[Sentence]:
    yield sentence("| the player, with all that it supports | {} bytes |", source.bench("player", "uno"))
    yield sentence("| the whole program, without the motion | {} bytes |",
                   source.bench("program without its motion", "uno"))


def experiments(source: Sources) -> Iterator[Sentence]:
    """docs/experiments.md: what is measured anew; all else there was measured once."""
    found = source.record("closures")
    yield sentence("a jaw of 500 us rests {} us above it in the median *p, b, m* of eight voices, and is within 10 us "
                   "in {} %.", found["short"], found["reach"])
    yield sentence("Openings are at most {} FAP units in {} *p, b, m*; in 95 % of {} *f, v* at least {}.",
                   *(found[name] for name in ("stops: most", "stops", "f, v", "f, v: 95 %")))


def laughing(source: Sources) -> Iterator[Sentence]:
    found = source.record("laughs")
    steps = [key.split(" ")[0] for key in found if key.endswith(" largest")]

    def cells(name: str) -> List[str]:
        return [count(found[f"{step} {name}"]) for step in steps]

    yield row("intensity", *steps)
    yield row("largest opening, mean of the laughs", *cells("largest"))
    yield sentence("| least and most of them |" + " {} .. {} |" * len(steps),
                   *(figure for pair in zip(cells("least"), cells("most")) for figure in pair))
    yield row("largest FAP 3 (jaw), mean", *cells("jaw"))
    yield row("FAP 53 (corner), mean of all frames", *cells("corner"))
    yield sentence("Speech opens up to {}.", found["speech"])


def results(source: Sources) -> Iterator[Sentence]:
    talkers = _talkers(source)["voice"]
    free, others, everyone = talkers.of(True), talkers.of(False), list(talkers.each.values())
    yield sentence("Summary, other people: on {} labels of talkers of whom the training has nothing, the device's "
                   "motion correlates by {} ± {} (standard error)", word(len(everyone)), *mean_and_error(everyone))
    yield sentence("by {} with {} who speak freely, by {} ± {} with {} labels of other talkers of GRID",
                   share(fmean(free)), word(len(free)), *mean_and_error(others), word(len(others)))
    alone = _talkers(source)["method"]
    yield sentence("Trained on s1 alone it reaches {} ± {}, and the published method {} ± {}",
                   *(figure for one in (alone, _talkers(source)["paper"]) for figure in one.cells()[3:]))
    diff, other, unseen = (source.results.table(section, place) for section, place in
                           ((RANDOM, DIFF), (RANDOM, OTHER), (UNSEEN, OTHER)))
    moves = [number(line["amplitude"]) for made, line in other.items() if made not in ("human", MEAN, FLOAT, DEVICE)]
    yield sentence("It moves wider than any other method ({} of human; others {} to {})",
                   _cell(other[DEVICE]["amplitude"]), share(min(moves)), share(max(moves)))
    yield sentence("at least as evenly as people do (jitter {}, of which {} comes from the device's whole FAP units)",
                   _cell(other[DEVICE]["jitter"]),
                   share(number(other[DEVICE]["jitter"]) - number(other[FLOAT]["jitter"])))
    yield sentence("its motion changes as people's does (seam {}, people {})",
                   *(decimal(number(other[who]["seam, mean"]), 2) for who in (DEVICE, "human")))
    yield sentence("A lip-reader trained on people reads {} of the words", _cell(other[DEVICE]["with residual"]))
    yield sentence("the readability of unseen letters ({}, people {})", _cell(unseen[DEVICE]["readability"]),
                   _cell(unseen["human"]["readability"]))
    yield sentence("its error on known words is {}, that of its own steps under a Gaussian blur {}, and it closes {} "
                   "of p, b, m. With normalised features the error is {}, and {} close.",
                   *(_cell(diff[made]["mean"], 4) for made in (PAPER, BLUR)), _cell(other[PAPER]["closure"]),
                   _cell(diff[NORMALISED]["mean"], 4), _cell(other[NORMALISED]["closure"]))
    yield from _laughter(source.results.table(LAUGHTER, DIFF), source.results.table(LAUGHTER, OTHER))
    for group, method, cells in _real_lips(source, ("opening", "jaw", "upper lip", "lower lip", "corners",
                                                    "mean of five")):
        yield row(f"{group} | {method}", *cells)


def _laughter(diff: Table, other: Table) -> Iterator[Sentence]:
    ridge = "ridge, class window + shapes"

    def errors(*methods: str) -> List[str]:
        return [_cell(diff[made]["mean"], 4) for made in methods]

    def shares(head: str, *methods: str, digits: int = 2) -> List[str]:
        return [_cell(other[made][head], digits) for made in methods]

    yield sentence("Labial ({}) is ahead of HMM synthesis ({}), Cohen-Massaro dominance ({}), ridge regression ({}), "
                   "linear regression ({}) and the published method ({}), also by its correlation, {} ({}, {} and {} "
                   "of the first three)", *errors(DEVICE, HMM, DOMINANCE, ridge, REGRESSION, PAPER),
                   *shares("correlation", DEVICE, HMM, DOMINANCE, ridge, digits=3))
    yield sentence("It moves wider than HMM synthesis ({} of the original against {}) and shows as many of the pulses "
                   "as the original ({})", *shares("amplitude", DEVICE, HMM), *shares("pulses seen", DEVICE))
    yield sentence("the error of openness ({} against {}), the rise of pulses ({} of the original against {}), jitter "
                   "({} against {}; {} in float64) and seams ({} against {}; the original {}).",
                   *(_cell(diff[made]["openness"], 4) for made in (HMM, DEVICE)),
                   *shares("rise of pulses", HMM, DEVICE), *shares("jitter", HMM, DEVICE, FLOAT),
                   *shares("seam, mean", HMM, DEVICE, "synthetic original"))


def streams(source: Sources) -> Iterator[Sentence]:
    code = sum(source.bench(f"code -Os: {name}.c", "m4") for name in _VOICE)
    yield sentence("It needs {} KB of RAM for the follower, its stream included, {} bytes of workspace, {} bytes of "
                   "stack, and 16 bytes for each phoneme", _kilobytes(source.bench("labial_voice_t", "m4"), 1),
                   source.bench("speech: workspace", "m4"), source.bench("stack -Os: voice.h", "m4"))
    yield sentence("twice as much for a word; {} KB of code (Cortex-M4, `-Os`)", _kilobytes(code, 1))


def timings(source: Sources) -> Iterator[Sentence]:
    yield lines("| service | what it reports | `--from` |\n|---|---|---|",
                (f"| {service['title']} | {', '.join(told['kind'] for told in service['tells'])} | `{name}` |"
                 for name, service in source.services.items() if service["tells"][-1]["kind"] in ("words", "characters")
                 and name not in ("azure", "polly", "words")))


#: Every page with figures.
PAGES: Dict[str, Callable[[Sources], Iterator[Sentence]]] = {
    "README.md": readme, "DESIGN.md": design, "export/RESULTS.md": results, "docs/arduino.md": arduino,
    "docs/beside.md": beside, "docs/browser.md": browser, "docs/esp32-hear.md": esp32_hear,
    "docs/experiments.md": experiments, "docs/figures.md": costs, "docs/hearing.md": hearing,
    "docs/laughing.md": laughing, "docs/method.md": method, "docs/packages.md": packages, "docs/porting.md": porting,
    "docs/python.md": python, "docs/reproduction.md": reproduction, "docs/servos.md": servos,
    "docs/streams.md": streams, "docs/timings.md": timings, "docs/words.md": words}
