"""Signs in texts of other languages than English: which of them are looked up, with which numbers, and what is said of
those for which espeak-ng is silent or has English alone."""

from __future__ import annotations

import re
from typing import Dict

_CURRENCIES = "$€£¥₹₽"
#: Signs as they are written in a common way: those as wide as ideographs, and those of two characters in one.
_WRITTEN = str.maketrans({**{chr(code + 0xFEE0): chr(code) for code in range(0x21, 0x7F)},
                          "￥": "¥", "￡": "£", "℃": "°C", "℉": "°F", "−": "-"})
#: What is looked up: a number with the sign before it or its percent sign, since these may change places; degrees and
#: sums with what is written behind them, as Korean has it; any other sign alone. A hyphen is a minus before a number,
#: at the beginning of a word.
_BEFORE = rf"(?:(?<![^\s(])[-−][{_CURRENCIES}]?|[{_CURRENCIES}＄￥￡#№§])"
PATTERN = (rf"R\$|(?<![^\W_])(?:{_BEFORE}\d+(?:[.,]\d+)*[%％]?|\d+(?:[.,]\d+)*[%％])(?![^\W_])|"
           rf"[°€£¥₹₽￥￡℃℉][^\W\d_]*|[%‰&+=@§№$％＆＋＝＠＄]")
#: A number with such signs.
NUMBER = re.compile(rf"[-−]?[{_CURRENCIES}＄￥￡#№§]?\d[\d.,]*[%％]?")
_CHINESE = "% 百分之 °C 摄氏度 ° 度 € 欧元 £ 英镑 $ 美元 ¥ 元 ₹ 卢比 ₽ 卢布 & 和 + 加 = 等于 № 号 # 号 - 负"
_SAID: Dict[str, Dict[str, str]] = {
    language: dict(zip(words.split()[::2], words.split()[1::2]))
    for language, words in {
        "ar": "- ناقص % بالمئة ° درجة & و + زائد = يساوي", "cmn": _CHINESE, "de": "₽ Rubel",
        "es": "¥ yenes № número - menos",
        "fr": "= égale § paragraphe № numéro # numéro - moins",
        "hi": "€ यूरो £ पाउंड ¥ येन ₹ रुपये °C डिग्री_सेल्सियस ° डिग्री & और - माइनस",
        "it": "¥ yen",
        "ja": "% パーセント °C ど ° ど € ユーロ £ ポンド $ ドル ¥ えん & アンド + プラス = イコール "
              "@ アット - マイナス",
        "ko": "% 퍼센트 °C 도 ° 도 € 유로 £ 파운드 $ 달러 ¥ 엔 & 앤드 + 플러스 = 는 - 마이너스",
        "pl": "€ euro - minus",
        "pt": "R$ reais",
        "ru": "€ евро £ фунтов ¥ иен ₹ рупий ₽ рублей °C градусов_цельсия ° градусов § параграф & и "
              "- минус",
        "yue": _CHINESE,
    }.items()
}


#: The hour, in languages that write times such as 14h30; and a date whose points are not said.
_HOURS, _TIME = {"es": "horas", "fr": "heures", "pt": "horas"}, re.compile(r"(\d\d?)h(\d\d)?")
_DATE = re.compile(r"(\d\d?)\.(\d\d?)\.(\d{2,4})")


def worded(text: str, language: str) -> str:
    """A text with its signs as `language`, "cmn" for any Chinese but "yue", says them; signs that espeak-ng says itself
    stay, and currencies stand behind their number."""
    time, date = _TIME.fullmatch(text), _DATE.fullmatch(text)
    if time and language.partition("-")[0] in _HOURS:
        return f"{time[1]} {_HOURS[language.partition('-')[0]]} {time[2] or ''}".strip()
    if date:
        return " ".join(date.groups())
    text = re.sub(rf"^(-?)([{_CURRENCIES}])(\d.*)", r"\1\3 \2", text.translate(_WRITTEN))
    if language in ("cmn", "yue"):
        text = re.sub(r"(\d[\d.,]*)%", r"百分之\1", text)
    for sign, word in _SAID.get(language.partition("-")[0], {}).items():
        if sign != "-" or re.match(r"-\d", text):
            text = text.replace(sign, f" {word} ".replace("_", " "), 1 if sign == "-" else -1)
    return text
