"""The reference of ``lib/words_text.c``: what is said where a text stands. ``include/labial/words.h`` has the rules.

Words follow each other in a text, and texts follow each other in a stream: `Context` goes from each to the next.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Dict, List, NamedTuple, Optional, Sequence, Tuple

from labial.words import characters as signs
from labial.words import numbers
from labial.words.characters import BLANK, FOREIGN, simple_characters
from labial.words.dictionary import LONGEST
from labial.words.said import Context, Said, inflected
from labial.words.tables import WordTables

#: Characters that are read, and phonemes that they become at most (LABIAL_WORDS_CHARACTERS, LABIAL_WORDS_PHONEMES).
CHARACTERS, PHONEMES = 255, 96
#: Words of a tag or stage direction, at most.
_DIRECTION = 8

_SIGNS = {"&": "and", "@": "at", "%": "percent", "+": "plus", "=": "equals", signs.TIMES: "times",
          signs.DIVIDED: "divided by", signs.SQUARE: "squared", signs.CUBE: "cubed", signs.ABOUT: "about",
          signs.MOST: "less than or equal to", signs.LEAST: "greater than or equal to", signs.EITHER: "plus or minus"}
#: Signs that are said before a number.
_BEFORE = {"#": "number", "<": "less than", ">": "greater than", "~": "about", "^": "to the power of"}
_POWERS = {signs.SQUARE: "square ", signs.CUBE: "cubic "}
#: Abbreviations, and words that the trees would misread, with what is said, or - if they are read letter by letter.
_MEANINGS: Dict[str, str] = dict(line.split(" ", 1) for line in """mr mister;mrs missiz;ms mizz;dr doctor;st saint
prof professor;appt appointment;qty quantity;jr junior;sr senior;vs versus;etc etcetera;approx approximately
dept department;govt government;blvd boulevard;rd road;hwy highway;mt mount;ltd limited;sgt sergeant;capt captain
lt lieutenant;wi why;fi fie;wifi why fie;ph -;phd -;www -;http -;https -;ftp -;edu ee dee you;ascii askey;jpeg jay peg
jpg jay peg;mpeg em peg;json jason;yaml yamel;hvac aitch vack;cmos sea moss;hipaa hippa;gnu new;pp pages;vol volume
facade fah sod;ok -;omg -;idk -;btw -;fyi -;tbh -;pls please;plz please;thx thanks;nato nay toe;uber oober;xbox ex box
gmail jee mail;gee jee;youtube you tube;android an droid;nvidia en vidia;mysql my sequel;nginx engine ex
kubernetes cooper netties;latte lah tay;karate cah rah tee;anime annie may;bouquet boo kay;ballet bal lay
cliche klee shay;debris deh bree;openai open ay eye;ext extension;ctrl control;airbnb air bee en bee
pilates pee lah teez;y'all yawl;usb -;cpu -;gpu -;url -;abc -;diy -;faq -;ceo -;cfo -;usa -;uk -;eu -;ai -;id -;nba -
xyz -;hdmi -;hbo -;tba -;ttyl -;wwi double_you double_you one;wwii double_you double_you two;lmao -;imo -;ugh ug
whoa woe;eww ee you;yuck yuk;lemme lemmy""".replace("\n", ";").split(";"))
#: What they mean behind a name; the first two unless another one follows; and words that are no names, at a sentence's
#: beginning.
_STREETS = {"st": "street", "dr": "drive", "ave": "avenue", "ln": "lane"}
_SAINTS = {"street": "saint", "drive": "doctor"}
_NO_NAMES = frozenset("""the my our your his her their he she it they we this that there what when where if in on at
    to from by near and but so for with is are no yes hi hello thanks dear ask call see st dr then you you'll
    turn go take walk continue keep follow after cross please now head look visit apt suite""".split())
#: Short names of months and days that are words otherwise; those with a point behind them are none, but the last two.
_DOUBTFUL = "Jan Mar Mon Sat Sun".split()
#: Words in short with a point, of which a number makes others, and such that mean others.
_NUMBERED = {"no": "number", "nos": "numbers", "ca": "circa", "p": "page", "ch": "chapter", "op": "opus",
             "est": "established", "rs": "rupees"}
_SHORTS = {"gen": "general", "gov": "governor", "sen": "senator", "rep": "representative", "rev": "reverend",
           "ft": "fort", "apt": "apartment", "fig": "figure"}
#: What is numbered: a letter that stands at such a number is no unit.
_PLACES = frozenset("""seat seats row gate gates room apartment apt flat suite unit bus exit hall platform section track
    terminal locker fig figure chapter part""".split())
#: Behind which the number of a telephone stands, and what may be between.
_CALLS, _CALLED = ("call", "dial"), ("us", "me", "at", "on", "now")
_SCALES = "hundred thousand million billion trillion".split()
#: Units behind a number, with names in singular and plural; those after the blank only where nothing is between.
_UNITS: Dict[str, str] = dict(line.split(" ", 1) for line in """km kilometer_;m meter_;cm centimeter_;mm millimeter_
nm nanometer_;um micrometer_;kg kilogram_;g gram_;mg milligram_;ug microgram_;lb pound_;lbs pound_;oz ounce_
ft foot|feet;yd yard_;mi mile_;mph mile_ per hour;kph kilometer_ per hour;L liter_;l liter_;ml milliliter_
mL milliliter_;cl centiliter_;dl deciliter_;dL deciliter_;gal gallon_;s second_;sec second_;secs second_
ms millisecond_;us microsecond_;ns nanosecond_;min minute_;mins minute_;h hour_;hr hour_;hrs hour_;Hz hertz
kHz kilohertz;MHz megahertz;GHz gigahertz;kB kilobyte_;KB kilobyte_;MB megabyte_;GB gigabyte_;TB terabyte_
kbps kilobit_ per second;Mbps megabit_ per second;Gbps gigabit_ per second;W watt_;kW kilowatt_;MW megawatt_
GW gigawatt_;Wh watt hour_;kWh kilowatt hour_;V volt_;mV millivolt_;kV kilovolt_;mA milliamp_;mAh milliamp hour_
dB decibel_;px pixel_;cal calorie_;kcal kilocalorie_;rpm are pee em;bpm bee pee em;fps eff pee ess
mpg mile_ per gallon;EUR euro_;GBP pound_;USD you ess dollar_;CAD canadian dollar_;AUD australian dollar_
CHF swiss franc_;JPY yen;INR rupee_;yr year_;yrs year_;tbsp tablespoon_;tsp teaspoon_;sq square;fl fluid;M million
bn billion;in inch|inches;A amp_;C degree_ celsius;F degree_ fahrenheit""".replace("\n", ";").split(";"))
_ATTACHED = ("M", "bn", "in", "A", "C", "F")
#: Units behind which another number and its unit belong to the same length or duration, and what marks them.
_PARTED = {"foot|feet": "f", "hour_": "h"}
#: Capitals that are read letter by letter although a word could look so, and words of two letters, of three that begin
#: with a vowel, and others that are words although they do not look so.
_SPELT = frozenset("""VIP MIT SOS POW SAP SAT GED RIP SEC GOP DOD LAX LED DEA NEA GRE SLA COO NIH ASAP UCLA USDA USAF
    USPS NYSE IMHO AFAIK MOU SME STI TWA CLI COD DOB GIS VOD LIDL NES CIS UTEP HBCU ICAO""".split())
_WORDS = frozenset("""AN AS AT BE BY DO GO HE HI IF IN IS ME MY NO OF OH ON OR OX SO TO UP WE YO HA AH UH UM EH
    ACE ACT ADD AGE AGO AHA AID AIM AIR ALL AND ANT ANY APP ARC ARE ARM ART ASH ASK ATE AXE EAR EAT EGG END EVE EYE ICE
    ILL INK INN ITS OAK ODD OFF OIL OLD ONE OUR OUT OWE OWN UGH USE GYM VIA AMY AVA BYE EVA IAN MIA LYNX MYTH NYMPH
    QUEUE""".split())
#: Of letters that are not all capitals, two to five without a vowel, none of them three times in a row, are read one by
#: one, but for sounds and parts of words.
_SOUNDS = frozenset("""hm hmm mm mhm grr brr pfft pff pst psst sh shh ssh tsk tss tch hmph nth zz bzz ll nt th
    nd mc ng""".split())
_SMALL = re.compile(r"(?!.*(.)\1\1)[b-df-hj-np-tv-xz]{2,5}$")
#: Parts of an address that are: countries, and what has no vowel.
_SPELT_IN_ADDRESS = re.compile("(?!co|go|me)[a-z]{2}|[b-df-hj-np-tv-xz]{1,4}")
#: Words unless the word before is not in capitals.
_SHOUTED = frozenset(["AM", "IT", "US", "WHO"])
_ONSETS = frozenset("""BL BR CH CL CR DR DW FL FR GH GL GR KN PH PL PR SC SH SK SL SM SN SP ST SQ SW TH TR TW WH WR SCR
    SHR SPL SPR STR THR""".split())
_CODAS = frozenset("""B C D F G H K L M N P R S T W X Z BB BT CH CK CT DD FF FT GG GH GN LD LF LK LL LM LP LT MB MN MP
    NG NK NN NT ND PH PT RB RC RD RF RK RL RM RN RP RT SH SK SM SP SS ST TH TT WD WL WN XT DTH FTH GHT LDT LTH NCH NTH
    PTH RCH RLD RNT RSH RST RTH TCH XTH DST HN PP RR SC""".split())
_PAIRS = frozenset("""AI AU AY EA EE EI EU EY IA IE IO OA OE OI OO OU OY UA UE UI UO UY YE YI EO AO UIE UEE EYE OYA AYE
    IOU AYO YA""".split())
_LAST_PAIRS = frozenset("AY EA EE EY IE OE OO OU OY UE UY".split())
#: Stage directions: the beginnings of verbs, behind which s, es or ing stands, and words that stand alone.
_VERBS = """applaud beam blink blush breath burp chuckl clap clapp clear cough cri cry exhal frown gasp giggl
    glanc grin grinn groan gulp hum humm inhal laugh mumbl mutter nod nodd paus pout scream shout shrug shrugg sigh sing
    smil smirk snap snapp snicker sniff snort sob sobb swallow wav whisper whistl wink yawn yell""".split()
_ALONE = frozenset("""applause beat blush breath chuckle clap cough cry gasp giggle grin groan gulp hum
    laugh laughter mumble music mutter nod pause quietly scream shout shrug sigh silence smile smirk sniff snort sob
    softly whisper whistle wink yawn yell""".split())
_DIRECTIONS, _LONGEST_VERB = frozenset(verb + end for verb in _VERBS for end in ("s", "es", "ing")), 12
#: Words in -s that are not verbs.
_NOT_VERBS = frozenset("always perhaps sometimes things this does yours ours theirs hers towards besides".split())

#: A square bracket and what stands in it, what may follow, and how words begin that are read.
_BRACKET, _ADDRESS = re.compile(r"\[[^\[\]]*"), re.compile(r"\](?:\(|\[[0-9\]])")
_TITLE = re.compile(r"\[[A-Z][a-z]*(?: |\Z)")
_RUN = re.compile(r"[A-Za-z](?:[A-Za-z]|'(?=[A-Za-z]))*")
_POINTED = re.compile(r"[A-Za-z](?:\.[A-Za-z](?![A-Za-z0-9\1]))+")
_CAMEL = re.compile(r"(?<=[a-z])(?=[A-Z])")
_STUTTER = re.compile(r"([A-Za-z])-(?=[a-z])(?=(?i:\1))(?!(?:tests?|day|boy|shaped)(?![A-Za-z0-9\1]|'[A-Za-z]))")
_LAUGH = re.compile("(?i)(h([aeio]))\\1+h?")
_LAUGHS = {"a": "hah", "e": "hee", "i": "hee", "o": "hoe"}
_DRAWN_OUT = re.compile(r"(?i)^(?=[^ivx].*[aeiouy]|[aeouy]).*([a-z])\1\1$")
_ROMAN = re.compile("(X{0,2})(I{1,3}|IV|VI{0,3}|IX)")
_ONES = "I II III IV V VI VII VIII IX".split()


class Reading(NamedTuple):
    """What a text sounds like."""

    kind: str  #: "silent", "read" or "unknown"
    phonemes: Tuple[Tuple[int, int, bool], ...]  #: phoneme, place of its character, whether a spoken word begins
    characters: int  #: of the text, `CHARACTERS` at most
    context: Context  #: for the next text


def read(tables: WordTables, text: str, before: Optional[Context] = None) -> Reading:
    """Reads a text behind those that led to `before`."""
    context = replace(before) if before else Context()
    context.dropped, context.is_old = 0, True
    said = Said(tables, simple_characters(text[:CHARACTERS]), context)
    reader = _Reader(said)
    place = 0
    while place < len(said.simple):
        place = reader.read_at(place)
    reader.end_word()
    kind = "read" if said.phonemes else "unknown" if said.foreign else "silent"
    return Reading(kind, tuple(said.phonemes), min(len(text), CHARACTERS), context)


class _Reader:
    """The rules, one character, word or sign after the other."""

    def __init__(self, said: Said) -> None:
        self.said, self.context, self.simple = said, said.context, said.simple
        self.address = False  #: a web address was recognised in this word

    def read_at(self, place: int) -> int:
        """Reads what begins at a place; returns the place behind it."""
        said, here = self.said, self.simple[place]
        said.foreign |= here == FOREIGN
        if self.context.closing:
            return self._skip(place)
        if here == BLANK:
            self.end_word()
            return place + 1
        if here.isdigit():
            return numbers.read_number(said, place)
        if here.isascii() and here.isalpha():
            return self._read_letters(place)
        if numbers.is_sum(said, place):
            return numbers.read_sum(said, place)
        return self._read_sign(place, here, said.at(place - 1))

    def end_word(self) -> None:
        """A blank, or the end of the text."""
        self.address = self.said.letters = False
        if self.context.closing:
            self.context.left -= 1
            if not self.context.left:
                self.context.closing = ""

    # ---- Tags and stage directions

    def _skip(self, place: int) -> int:
        if self.simple[place] == BLANK:
            self.end_word()
        elif self.simple[place] == self.context.closing:
            is_address = self.context.closing == "]" and self.said.at(place + 1) == "("
            self.context.closing = ")" if is_address else ""
        return place + 1

    def _open(self, closing: str, place: int) -> int:
        self.context.closing, self.context.left, self.context.after = closing, _DIRECTION, ""
        return place + 1

    def _is_tag(self, place: int) -> bool:
        """Whether what a square bracket begins is silent: all but the text of a link, behind which an address or the
        number of one stands. Where the end is not in sight, since words come one by one, a first word with a capital
        and small letters is the text of a link, unless it is a stage direction."""
        found = _BRACKET.match(self.simple, place)
        assert found is not None
        if self.said.at(place + 1) == BLANK or self.said.at(found.end()) == "[":
            return False
        if _ADDRESS.match(self.simple, found.end()):
            return not re.search("[A-Za-z\1]", found[0])
        return not _TITLE.match(self.simple, place) or self._is_direction(place, "]")

    def _is_direction(self, place: int, closing: str) -> bool:
        found = re.compile("[A-Za-z]+").match(self.simple, place + 1)
        follows = self.said.at(found.end()) if found else ""
        if not found or signs.is_inside(follows) or len(found[0]) > _LONGEST_VERB:
            return False
        word = found[0].lower()
        return (closing in (follows, "]") and word in _ALONE) or word in _DIRECTIONS or (
            closing == "*" and follows == BLANK and found[0] == word and len(word) > 3 and word.endswith("s")
            and not word.endswith("ss") and word not in _NOT_VERBS)

    # ---- Signs

    def _read_sign(self, place: int, here: str, before: str) -> int:
        said, follows = self.said, self.said.at(place + 1)
        if here == "[" and self._is_tag(place):
            return self._open("]", place)
        if here == "<" and (follows in "/!?" or (follows.isascii() and follows.isalpha())):
            return self._open(">", place)
        if here == "]" and follows == "(":
            return self._open(")", place + 1)
        if here in "(*" and before != "*" and self._is_direction(place, ")" if here == "(" else "*"):
            return self._open(")" if here == "(" else "*", place)
        if self.context.after in ("date", "day", "place") and here in ",-/" and before != BLANK and not self.address:
            self.context.named = False
            return place + 1
        after = self.context.after
        self.context.after, self.context.tail, self.context.named = "", 0, False
        if after in ("call", "phone") and here in "(+):":
            self.context.after = after
        if here == "-" and after in ("one", "number") and re.match("[A-Za-z]{2}", self.simple[place + 1 :]):
            end = self._read_unit(place + 1, "one", True)
            if end:
                return end
        said.letters &= here == "-"
        is_counted, currency = after in ("one", "number"), numbers.currency_of(here)
        if here == signs.DEGREE:
            said.say("degree" if after == "one" else "degrees", place)
            scale = {"C": "celsius", "F": "fahrenheit"}.get(follows)
            if not scale or signs.is_inside(said.at(place + 2)):
                return place + 1
            said.say(scale, place + 1)
            return place + 2
        if here == "." and follows.isdigit() and not signs.is_inside(before):
            self.context.after = "number"
            return numbers.read_fraction(said, place)
        if here == "/" and after in ("unit", "sum") and follows.isascii() and follows.isalpha():
            said.say("per", place)
            self.context.after = "per"
        elif here in (".", "/", "-", "_", ":"):
            return self._read_joint(place, here, before, follows)
        elif here == signs.MINUS:
            said.say("minus", place)
        elif (here == signs.CENT or currency >= 0) and is_counted:
            said.say(inflected("cent_" if currency < 0 else numbers.CURRENCIES[currency], after == "number"), place)
        elif currency >= 0 and follows == BLANK:
            self.context.after, self.context.currency = "money", currency
        elif here in _BEFORE and follows.isdigit():
            said.say(_BEFORE[here], place)
        elif here == "#" and before.isascii() and before.isalpha() and not signs.is_inside(follows):
            said.say("sharp", place)
        elif here == '"' and follows != BLANK and not signs.is_inside(before):
            self.context.quoted = True
        elif here == '"':
            if before.isdigit() and not self.context.quoted:
                said.say("inch", place)
                self.context.after = "unit"
            self.context.quoted = False
        elif here in _SIGNS:
            said.say(_SIGNS[here], place)
        return numbers.read_range(said, place + 1) if here == "%" else place + 1

    def _read_joint(self, place: int, here: str, before: str, follows: str) -> int:
        """Signs that are said within an address, a minus before a number."""
        said = self.said
        is_small = follows.isascii() and follows.islower()
        is_letter = follows.isascii() and follows.isalpha()
        if here == "." and (is_small and signs.is_inside(before) or is_letter and before == BLANK):
            said.say("dot", place)
            self.address = True
        elif here == ":" and signs.is_inside(before) and self.simple.startswith("//", place + 1):
            said.say("colon slash slash", place)
            self.address = True
            return place + 3
        elif here == "-" and (follows.isdigit() or numbers.is_sum(said, place + 1)) and before in (BLANK, "("):
            said.say("minus", place)
        elif self.address and signs.is_inside(follows) and here != ".":
            said.say({"/": "slash", "-": "dash", "_": "underscore", ":": "colon"}[here], place)
        return place + 1

    # ---- Letters

    def _read_letters(self, place: int) -> int:
        while _STUTTER.match(self.simple, place) and not signs.is_inside(self.said.at(place - 1)):
            place += 2
        before, named, after = self.said.at(place - 1), self.context.named, self.context.after
        self.context.named, self.context.after = False, ""
        pointed = _POINTED.match(self.simple, place)
        if pointed:
            return self._read_pointed(pointed[0], place, after)
        if after in ("one", "number", "per", "phone"):
            end = self._read_unit(place, after, before == BLANK)
            if end:
                return end
        run, places = _run_at(self.simple, place)
        self.said.letters = True
        end = places[-1]
        is_pointed = self._read_run(run, places, after, before, named)
        if self.context.after == "with":
            return end + 1
        if run.lower() in ("am", "pm") and after in ("one", "number", "time"):
            return numbers.read_range(self.said, end)
        return end + (is_pointed and self.said.at(end) == ".")

    def _read_pointed(self, text: str, place: int, after: str) -> int:
        meaning = {"e.g": "for example", "i.e": "that is"}.get(text[:3].lower())
        if meaning:
            self.said.say(meaning, place)
            return place + 3
        is_hour = text.lower() in ("a.m", "p.m") and after in ("one", "number", "time")
        if is_hour and after == "time":
            self.said.take_back()
        self.said.say_names(text[::2].lower(), range(place, place + len(text), 2), False)
        end = place + len(text)
        if is_hour and self.said.at(end) == "." and numbers.is_range(self.said, end + 1):
            return numbers.read_range(self.said, end + 1)
        return end

    def _read_unit(self, place: int, after: str, is_apart: bool) -> int:
        """Reads a unit behind a number; returns the place behind it, or 0."""
        found = re.compile(r"[A-Za-z]{1,4}(?![A-Za-z0-9\1]|'[A-Za-z])").match(self.simple, place)
        context, unit = self.context, found[0] if found else ""
        if not found or unit not in _UNITS:
            return 0
        is_inch = unit == "in" and self.said.at(found.end()) == "."
        if is_apart and unit in _ATTACHED and context.mark != "f" and not is_inch:
            return 0
        name = "minute_" if context.mark == "h" and unit == "m" else _UNITS[unit]
        power = _POWERS.get(self.said.at(found.end()), "")
        self.said.say(power + inflected(name, after in ("number", "phone")), place)
        context.after = "unit" if unit not in ("M", "bn", "sq", "fl") else "number"
        context.tail, context.mark = 0, _PARTED.get(name, "")
        end = found.end() + bool(power)
        if context.mark == "f" and self.said.at(end) == ".":
            return end + 1
        return numbers.read_range(self.said, end)

    def _read_run(self, run: str, places: Sequence[int], after: str, before: str, named: bool) -> bool:
        """Reads letters that belong together, whose last place is behind them; whether a point there is theirs."""
        said, context, small, place = self.said, self.context, run.lower(), places[0]
        follows = said.at(places[-1])
        shouting, context.shouting = context.shouting, False
        context.named = run[0].isupper() and len(run) > 1 and small not in _NO_NAMES
        if context.named and after in _SAINTS:
            said.take_back()
            said.say(_SAINTS[after], place)
        if after == "place" and (len(run) == 1 or small in ("and", "or", "to")):
            context.after = "place"
        if after == "call" and small in _CALLED:
            context.after = "call"
        date = _date_of(run)
        owner = _owner(run)
        number = _roman(owner, named or after == "place")
        if number:
            said.say(" ".join(numbers.cardinal(str(number))), place)
            if owner != run:
                said.add_s(places[len(owner) - 1])
        elif named and small in _STREETS:
            said.say_tail(_STREETS[small], place)
            context.after = _STREETS[small]
            return True
        elif small in ("am", "pm") and run in (small, small.upper()) and after in ("one", "number", "time"):
            said.take_back() if after == "time" else None
            said.say_names(small, places, False)
        elif small == "o'clock" and after == "time":
            said.take_back()
            self._spell(run, places)
        elif small in _SCALES and after == "sum":
            said.take_back()
            said.say(f"{small} {inflected(numbers.CURRENCIES[context.currency], True)}", place)
        elif date:
            self._read_date(run, date, places, after, follows == ".")
            return run != date
        elif follows == "." and small in _NUMBERED and run in (small, small.title()) and not self.address and (
                run == small or len(run) > 1):
            self._spell_tail(run, places, self._is_spelt(run, before, follows, shouting))
            context.after, context.short = "no", _NUMBERED[small]
            return True
        elif follows == "." and small in _SHORTS and run != small and not self.address:
            said.say(_SHORTS[small], place)
            context.after = "place" if small in _PLACES else context.after
            return True
        elif run == "x" and after in ("one", "number", "unit") and before == follows == BLANK:
            said.say("by", place)
        elif _LAUGH.fullmatch(run):
            for letter in range(0, len(run) - 1, 2):
                said.say(_LAUGHS[small[1]], places[letter])
        elif run == "w" and follows == "/":
            said.say("with", place)
            context.after = "with"
        elif small == "o" and after == "with":
            said.say("out", place)
        elif (small in _PLACES or small in _CALLS) and before not in (";", "&"):
            self._spell(run, places)
            context.after, context.shouting = "place" if small in _PLACES else "call", run.isupper()
        elif small in _MEANINGS and before not in (";", "&"):
            if _MEANINGS[small] == "-":
                said.say_names(small, places, False)
            else:
                said.say(_MEANINGS[small], place)
        elif self.address and before == "." and _SPELT_IN_ADDRESS.fullmatch(small):
            said.say_names(small, places, False)
        else:
            is_spelt = self._is_spelt(run, before, follows, shouting)
            self._spell(run, places, is_spelt)
            context.shouting = not is_spelt and run.isupper() and (len(run) > 1 or run == "I")
        return False

    def _read_date(self, run: str, name: str, places: Sequence[int], after: str, is_pointed: bool) -> None:
        """Reads a month or a day, whose name the run is or begins. Names that are words otherwise are dates behind the
        number of a day, next to another date and, but for Sat and Sun, with a point; if none of this holds, what
        follows may correct them."""
        context, place = self.context, places[0]
        if after == "date":
            self.said.correct(place)
        is_sure = (run[:3] not in _DOUBTFUL or after in ("date", "day")
                   or (is_pointed and run[:3] not in _DOUBTFUL[-2:]))
        context.after = "month" if name in numbers.MONTHS else "day"
        if name in numbers.MONTHS and after in ("one", "number") and context.tail:  # an ordinal, and no day follows
            self.said.take_back()
            numbers.say_ordinal(self.said, str(context.day), place)
            context.after = ""
        if run == name:
            self._spell(run, places)
        elif is_sure or not context.after:
            self.said.say(name.lower(), place)
        else:
            self._spell_tail(run, places, False)
            context.after, context.short = "date", name.lower()

    def _spell_tail(self, run: str, places: Sequence[int], is_spelt: bool) -> None:
        """Says a word that the next one may take back."""
        before = len(self.said.phonemes)
        self._spell(run, places, is_spelt)
        self.context.tail, self.context.is_old = len(self.said.phonemes) - before, False

    def _spell(self, run: str, places: Sequence[int], is_spelt: bool = False) -> None:
        if is_spelt:
            letters = _capitals(run) or _owner(run)
            self.said.say_names(letters.lower(), places, letters != run)
            return
        sounds = [self.said.characters[places[letter]].sound for letter in range(len(run))]
        self.said.spell(run.lower(), lambda letter: places[letter], sounds)

    def _is_spelt(self, run: str, before: str, follows: str, shouting: bool) -> bool:
        """Whether letters are read one by one."""
        if len(run) == 1:
            return run not in "aAiI" or (run == "A" and (bool(re.search("[0-9&+/]", before)) or follows != BLANK))
        letters = _capitals(run)
        if not letters:
            small = _owner(run).lower()
            return small not in _SOUNDS and bool(_SMALL.match(small))
        if len(letters) == 1:
            return before == "&" or (before.isascii() and before.isalpha())
        if len(letters) > 5:
            return False
        if "&" in (before, follows) and letters == run:
            return True
        if letters in _SHOUTED:
            return not shouting
        return letters in _SPELT or not (letters in _WORDS or is_pronounceable(letters))


def _run_at(simple: str, place: int) -> Tuple[str, List[int]]:
    """Letters that belong together, up to a capital behind a small one, and their places, with that behind them. Of a
    letter that is drawn out, as in "sooo", one is read, or two of e and o within a word, as in "goood"."""
    found = _RUN.match(simple, place)
    assert found is not None
    run, places, here = "", [place], place
    while here < found.end() and len(run) < LONGEST and not (run and _CAMEL.match(simple, here)):
        run += simple[here]
        here += 1
        if _DRAWN_OUT.search(run):
            while simple[here : here + 1] == run[-1]:
                here += 1
            goes_on = here < found.end() and simple[here] != "'"
            if goes_on or len(run) > 3:
                left = 1 if goes_on and run[-1] in "eoEO" else 2
                run, places = run[:-left], places[: len(places) - left]
        places.append(here)
    while run.endswith("'"):
        run, places = run[:-1], places[:-1]
    return run, places


def _date_of(run: str) -> str:
    """The month or day whose name a run is or begins: with three letters, or up to five from s on; or nothing."""
    names = (*numbers.MONTHS, *numbers.DAYS) if run == run.title() and len(run) > 2 else ()
    return next((name for name in names if name.startswith(run) and (
        run == name or len(run) <= (5 if name[0] >= "S" else 3))), "")


def _roman(run: str, is_named: bool) -> int:
    """The number of Roman numerals up to 29: three letters or more, II, two capitals behind what `is_named`; or 0."""
    found = _ROMAN.fullmatch(run.upper())
    if not found or len(run) < 2 or (len(run) == 2 and found[2] != "II" and not (is_named and run.isupper())):
        return 0
    return 10 * len(found[1]) + _ONES.index(found[2]) + 1


def _owner(run: str) -> str:
    """Letters without the 's behind them."""
    return run[:-2] if len(run) > 2 and run.lower().endswith("'s") else run


def _capitals(run: str) -> str:
    """The capitals that a run consists of, but for an s or 's behind them; nothing for other runs."""
    found = re.fullmatch("([A-Z]+)(?:'?s)?", run)
    return found[1] if found else ""


def is_pronounceable(letters: str) -> bool:
    """Whether three to five capitals look like a word: as words of English begin and end, with vowels that stand
    together in them."""
    vowels = [letter in "AEIOU" or (letter == "Y" and place > 0) for place, letter in enumerate(letters)]
    if len(letters) < 3 or True not in vowels or (len(letters) == 3 and vowels[0]):
        return False
    first, last = vowels.index(True), len(letters) - vowels[::-1].index(True)
    onset, coda = letters[:first], letters[last:]
    is_coda = not coda or coda in _CODAS or (coda[-1] == "S" and coda[:-1] in _CODAS)
    if (len(onset) > 1 and onset not in _ONSETS) or not is_coda or (coda and not re.search("[AEIOU]", letters)):
        return False
    runs = re.findall("[AEIOUY]+", letters[first:last])
    allowed = _LAST_PAIRS if len(letters) == 3 else _PAIRS
    return all(len(run) == 1 or run in allowed for run in runs)
