"""The reference of ``lib/words_numbers.c``: numbers, sums, dates and times as they are said."""

from __future__ import annotations

import re
from typing import Callable, List, Optional, Tuple

from labial.words import characters as signs
from labial.words.said import Said, inflected

_UNITS = ("zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen "
          "seventeen eighteen nineteen").split()
_TENS = "twenty thirty forty fifty sixty seventy eighty ninety".split()
_SCALES = ("trillion", "billion", "million", "thousand", "")
_ORDINALS = {"one": "first", "two": "second", "three": "third", "five": "fifth", "eight": "eighth", "nine": "ninth",
             "twelve": "twelfth"}
MONTHS = ("January February March April May June July August September October November December").split()
DAYS = "Monday Tuesday Wednesday Thursday Friday Saturday Sunday".split()
_MOST_DIGITS = 15
#: Signs of money, the names of whole units and of their hundredths.
_SIGNS = "$" + signs.EURO + signs.POUND + signs.YEN + signs.RUPEE
CURRENCIES = ("dollar_", "euro_", "pound_", "yen", "rupee_")
_HUNDREDTHS = ("cent_", "cent_", "penny|pence", "", "paisa|paise")
_LETTER_SCALES = {"k": "thousand", "m": "million", "mn": "million", "b": "billion", "bn": "billion", "t": "trillion",
                  "tn": "trillion"}
#: What ends a word: no letter and no digit.
END = r"(?![A-Za-z0-9\1])"
_WHOLE = re.compile(r"[0-9]+(?:,[0-9]{3}(?![0-9]))*")
_FRACTION = re.compile(r"\.([0-9]+)")
_DIGITS = re.compile(r"[0-9](?:,?[0-9])*")
_ISO = re.compile(r"([0-9]{4})([/-])([0-9]{1,2})\2([0-9]{1,2})(?:" + END + "|(?=T[0-9]))")
_DATE = re.compile(r"([0-9]{1,2})([/.-])([0-9]{1,2})\2([0-9]{4}|[0-9]{2})" + END)
_PHONE = re.compile(r"(?:[0-9]{1,4}(?:-[0-9]{2,4}){2,}|[0-9]{3}-[0-9]{4}|[0-9](?:-[0-9]){2,})(?![A-Za-z0-9\1-])"
                    r"|[0-9](?:-[0-9]{2,4})+(?=-[A-Z])"
                    r"|[2-9][0-9]{2}(?P<sign>[. ])[0-9]{3}(?P=sign)[0-9]{4}(?!(?P=sign)?[0-9])(?![A-Za-z\1])")
_GROUPS = (re.compile(r"[0-9]+(?:[- ][0-9]+)*"), re.compile(r"[0-9]+(?:\.[0-9]+){2,}"))
_GROUP = re.compile(r"[0-9]+(?![A-Za-z0-9\1%'/:-]|[.,][0-9])")
_AREA = re.compile(r"[2-9][0-9]{2}(?=\))")
_TIME = re.compile(r"([0-9]{1,2}):([0-9]{2})(?::([0-9]{2}))?(?![0-9:])")
_SHARE = re.compile(r"([0-9]{1,2})/([0-9]{1,3})(?![A-Za-z0-9\1/])")
_FEET = re.compile(r"([0-9]{1,2})'([0-9]{1,2})" + END + '"?')
_ORDINAL = re.compile("(?:st|nd|rd|th)" + END, re.IGNORECASE)
#: Numbers behind which s is no second, "747s"; and letters that are no units where letters name what is numbered.
_MODEL, _PLURAL, _LETTER = re.compile("[0-9]{2,3}[1-9]"), re.compile("s" + END), re.compile("[A-Za-z]" + END)
_DAY = re.compile(r"([0-9]{1,2})(?![A-Za-z0-9\1:/]|[.,][0-9])")
_YEAR = re.compile(r"(?:1[1-9]|20)[0-9]{2}(?![A-Za-z0-9\1%]|\.[0-9])")
_DECADE = re.compile(r"((?:1[1-9]|20)[0-9]0|[2-9]0)'?s" + END)
_SCALE = re.compile(r"(bn|mn|tn|[kmbt])" + END, re.IGNORECASE)
_DENOMINATORS = {2, 3, 4, 5, 6, 7, 8, 9, 10, 16, 32, 64, 100}


def is_sum(said: Said, place: int) -> bool:
    """Whether a sign of money and its number begin here."""
    return said.at(place) in _SIGNS and said.at(place + 1 + (said.at(place + 1) == ".")).isdigit()


#: The number of a sign of money, or -1.
currency_of = _SIGNS.find


def read_sum(said: Said, place: int) -> int:
    """Reads a sign of money and its number; returns the place behind them."""
    said.context.currency, said.context.named = currency_of(said.simple[place]), False
    return _read_amounts(said, place + 1, place)


def _read_amounts(said: Said, place: int, at: int) -> int:
    end, is_lower = _read_amount(said, place, at, False)
    while is_lower:
        end, is_lower = _read_amount(said, end, end, True)
    return end


def _read_amount(said: Said, place: int, at: int, is_upper: bool) -> Tuple[int, bool]:
    """Reads an amount of the context's currency, said at `at`; `is_upper` behind "to".

    Returns the place behind it, and whether the upper end of a range stands there without a sign of its own, as 10 does
    in "$5-10".
    """
    context, name = said.context, CURRENCIES[said.context.currency]
    hundredths = _HUNDREDTHS[context.currency]
    whole = _WHOLE.match(said.simple, place)
    digits = whole[0].replace(",", "") if whole else ""
    coded = _DIGITS.match(said.simple, place) if _is_coded(digits) else None
    number = coded or whole
    end = number.end() if number else place
    fraction = _FRACTION.match(said.simple, end)
    after = fraction.end() if fraction else end
    scale = _SCALE.match(said.simple, after)
    cents = fraction[1] if fraction and len(fraction[1]) == 2 and not scale and hundredths else None
    main = digits.lstrip("0")
    behind = scale.end() if scale else after
    is_lower = is_range(said, behind) and said.at(behind + 1).isdigit()
    context.after, context.tail = "sum", 0
    if cents is None or main or cents == "00":
        if coded:
            _say_digits(said, coded[0], place)
        else:
            said.say(" ".join(cardinal(digits)), at)
    if fraction and cents is None:
        read_fraction(said, end)
    if scale:
        said.say(_LETTER_SCALES[scale[1].lower()] + " " + inflected(name, True), after - 1)
        return read_range(said, behind), is_lower
    plural = is_upper or digits != "1" or (fraction is not None and cents is None)
    if cents is None:
        said.say_tail("" if is_lower else inflected(name, plural), after - 1)
    elif main or cents == "00":
        said.say(inflected(name, plural), end)
    if cents is not None and cents != "00":
        if main:
            said.say("and", end)
        said.say(" ".join(cardinal(cents)) + " " + inflected(hundredths, cents != "01"), end)
    return read_range(said, after), is_lower


def read_number(said: Said, place: int) -> int:
    """Reads what begins with a digit; returns the place behind it."""
    context, after = said.context, said.context.after
    is_start = not signs.is_inside(said.at(place - 1))
    is_month = after == "month"
    if after in ("no", "date"):
        said.correct(place)
        is_month = context.short.title() in MONTHS
    if after != "unit":
        context.mark = ""
    context.after, context.tail, context.named = "number", 0, False
    if after == "money" and is_start:
        return _read_amounts(said, place, place)
    end = _read_group(said, place, after) if after in ("call", "phone") and is_start else None
    for rule in (_read_date, _read_phone, _read_time, _read_share, _read_feet, _read_decade) if is_start else ():
        end = rule(said, place, after in ("one", "number")) if end is None else end
    if end is not None:
        return end
    day = _DAY.match(said.simple, place) if is_month and is_start else None
    if day and 1 <= int(day[1]) <= 31:
        say_ordinal(said, day[1], place)
        end = read_range(said, day.end())
        context.after = "month" if end > day.end() else ""
        return end
    year = _YEAR.match(said.simple, place) if is_start else None
    if year and not year[0].startswith("200"):
        said.say(" ".join(_year(year[0])), place)
        return read_range(said, year.end())
    end = _read_plain(said, place, is_start)
    if (after == "place" or said.letters) and _LETTER.match(said.simple, end):
        context.after = "place"
    return end


def _read_plain(said: Said, place: int, is_start: bool) -> int:
    whole = _WHOLE.match(said.simple, place)
    assert whole is not None
    digits, end = whole[0].replace(",", ""), whole.end()
    if _is_coded(digits):
        found = _DIGITS.match(said.simple, place)
        assert found is not None
        _say_digits(said, found[0], place)
        end = found.end()
        said.context.after = "phone" if is_start and len(digits) > 2 else "number"
    else:
        ordinal = _ORDINAL.match(said.simple, end)
        if ordinal:
            say_ordinal(said, digits, place)
            said.context.after, said.context.named = "", True
            return ordinal.end()
        if _PLURAL.match(said.simple, end) and (said.letters or _MODEL.fullmatch(digits)):
            said.say(_ended(cardinal(digits), _plural), place)
            said.context.after = ""
            return end + 1
        if is_start and not said.context.mark and len(digits) <= 2 and 1 <= int(digits) <= 31:
            said.say_tail(" ".join(cardinal(digits)), place)
            said.context.day = int(digits)
        else:
            said.say(" ".join(cardinal(digits)), place)
        if digits == "1":
            said.context.after = "one"
    while _FRACTION.match(said.simple, end):
        end = read_fraction(said, end)
        said.context.after, said.context.tail = "number", 0
    if said.at(place - 1) == "+" and said.characters[place].place == 1 and len(digits) < 4:
        said.context.after = "phone"
    return _behind(said, end) if is_start else end


def _behind(said: Said, end: int) -> int:
    """What may follow a number: another one up to which it reaches, or by which it is multiplied."""
    share = _read_share(said, end + 1, True) if said.at(end) == "-" else None
    if share:
        return share
    if said.at(end) in ("x", signs.TIMES) and said.at(end + 1).isdigit():
        said.say("by", end)
        return end + 1
    return read_range(said, end)


def is_range(said: Said, end: int) -> bool:
    """Whether a number that ends here reaches up to another one."""
    return said.at(end) in ("-", ":") and (said.at(end + 1).isdigit() or is_sum(said, end + 1))


def read_range(said: Said, end: int) -> int:
    """Reads "to" where a number reaches up to another one; returns the place behind it."""
    if is_range(said, end):
        said.say("to", end)
        return end + 1
    return end


def _read_date(said: Said, place: int, _: bool) -> Optional[int]:
    found = _ISO.match(said.simple, place)
    if found:
        year, month, day = found[1], int(found[3]), int(found[4])
    else:
        found = _DATE.match(said.simple, place)
        if not found or (found[2] != "/" and len(found[4]) == 2):
            return None
        month, day = int(found[1]), int(found[3])
        if found[2] == "." or month > 12:
            month, day = day, month
        year = found[4] if len(found[4]) == 4 else "20" + found[4]
    if not (1 <= month <= 12 and 1 <= day <= 31):
        return None
    said.say(MONTHS[month - 1].lower(), place)
    say_ordinal(said, str(day), place)
    said.say(" ".join(_year(year)), place)
    said.context.after = ""
    end = found.end() + (said.at(found.end()) == "T")
    return _read_time(said, end, False) or end


def _read_phone(said: Said, place: int, _: bool) -> Optional[int]:
    found = _abroad(said, place) if said.at(place - 1) == "+" else None
    found = found or _PHONE.match(said.simple, place)
    if not found and said.at(place - 1) == "(":
        found = _AREA.match(said.simple, place)
    if found:
        _say_digits(said, found[0], place)
        said.context.after = "phone" if found[0].isdigit() else ""
    return found and found.end()


def _read_group(said: Said, place: int, called: str) -> Optional[int]:
    """Reads a group of a telephone number, behind "call" or another group: digit by digit if it has three or more."""
    found = _GROUP.match(said.simple, place)
    if not found:
        return None
    is_short = len(found[0]) < 3
    if is_short or (called == "call" and int(found[0][:9]) % 100 == 0 and not _is_coded(found[0])):
        said.say(" ".join(cardinal(found[0])), place)
    else:
        _say_digits(said, found[0], place)
    said.context.after = called if is_short else "phone"
    return found.end()


def _abroad(said: Said, place: int) -> Optional[re.Match[str]]:
    """The number of a telephone behind a plus, 8 to 15 digits; two groups with a point are a number and a fraction."""
    for pattern in _GROUPS:
        found = pattern.match(said.simple, place)
        digits = sum(map(str.isdigit, found[0])) if found else 0
        if found and digits >= 8:
            is_abroad = digits <= _MOST_DIGITS and (digits == len(found[0]) or not found[0][:4].isdigit())
            return found if is_abroad and not signs.is_inside(said.at(found.end())) else None
    return None


def _read_time(said: Said, place: int, _: bool) -> Optional[int]:
    found = _TIME.match(said.simple, place)
    if not found or int(found[1]) > 24 or int(found[2]) > 59:
        return None
    hour = int(found[1])
    said.context.after = "time"
    said.say(" ".join(cardinal(str(hour))), place)
    seconds = found[3] if found[3] and found[3] != "00" else ""
    if found[2] != "00" or seconds:
        _say_minutes(said, found[2], found.start(2))
    elif is_range(said, found.end()):
        return read_range(said, found.end())
    elif 1 <= hour <= 12:
        said.say_tail("o'clock", place)
    else:
        said.say_tail("hundred", place)
    if seconds:
        _say_minutes(said, seconds, found.start(3))
    return read_range(said, found.end())


def _say_minutes(said: Said, digits: str, place: int) -> None:
    if digits[0] == "0" and digits != "00":
        said.say("oh", place)
    said.say(" ".join(cardinal(digits)), place)


def _read_share(said: Said, place: int, is_counted: bool) -> Optional[int]:
    found = _SHARE.match(said.simple, place)
    if not found or int(found[2]) not in _DENOMINATORS or not 0 < int(found[1]) < int(found[2]):
        return None
    count, parts = int(found[1]), int(found[2])
    if is_counted:
        said.say("and", place)
    name = {2: "half", 4: "quarter"}.get(parts)
    said.say("a" if is_counted and name and count == 1 else " ".join(cardinal(found[1])), place)
    said.say((name or _ended(cardinal(found[2]), _ordinal)) + "s" * (count > 1), place)
    return found.end()


def _read_feet(said: Said, place: int, _: bool) -> Optional[int]:
    found = _FEET.match(said.simple, place)
    if found:
        said.say(" ".join([*cardinal(found[1]), "foot", *cardinal(found[2])]), place)
    return found and found.end()


def _read_decade(said: Said, place: int, _: bool) -> Optional[int]:
    found = _DECADE.match(said.simple, place)
    if not found:
        return None
    said.say(_ended(_year(found[1]) if len(found[1]) == 4 else cardinal(found[1]), _plural), place)
    said.context.after = ""
    return read_range(said, found.end())


def _is_coded(digits: str) -> bool:
    """Whether digits are said one by one."""
    return len(digits) > _MOST_DIGITS or (len(digits) > 1 and digits[0] == "0")


def _say_digits(said: Said, text: str, place: int) -> None:
    for offset, digit in enumerate(text):
        if digit.isdigit():
            said.say(_UNITS[int(digit)], place + offset)


def read_fraction(said: Said, point: int) -> int:
    """Reads a point and digits; returns the place behind them."""
    found = _FRACTION.match(said.simple, point)
    assert found is not None
    said.say("point", point)
    _say_digits(said, found[1], point + 1)
    return found.end()


def say_ordinal(said: Said, digits: str, place: int) -> None:
    """Says a number as an ordinal."""
    said.say(_ended(cardinal(digits), _ordinal), place)


def _ended(words: List[str], ending: Callable[[str], str]) -> str:
    return " ".join([*words[:-1], ending(words[-1])])


def cardinal(digits: str) -> List[str]:
    """The words of up to 15 digits."""
    words: List[str] = []
    for part, name in zip(re.findall("...", digits.rjust(15, "0")), _SCALES):
        words += _below_thousand(int(part)) + [name] * bool(int(part) and name)
    return words or ["zero"]


def _below_thousand(value: int) -> List[str]:
    words = [_UNITS[value // 100], "hundred"] if value >= 100 else []
    rest = value % 100
    if rest >= 20:
        words.append(_TENS[rest // 10 - 2])
        rest %= 10
    return words + [_UNITS[rest]] * bool(rest)


def _year(digits: str) -> List[str]:
    """A year of four digits: two by two, except 2000 to 2009 and years below 1100 or above 2099."""
    century, rest = int(digits[:2]), int(digits[2:])
    if not (11 <= century <= 19 or (century == 20 and rest > 9)):
        return cardinal(digits)
    if rest == 0:
        return [*cardinal(digits[:2]), "hundred"]
    return [*cardinal(digits[:2]), *(["oh"] if rest < 10 else []), *cardinal(digits[2:])]


def _ordinal(word: str) -> str:
    if word in _ORDINALS:
        return _ORDINALS[word]
    return word[:-1] + "ieth" if word.endswith("y") else word + "th"


def _plural(word: str) -> str:
    return word[:-1] + "ies" if word.endswith("y") else word + "s"
