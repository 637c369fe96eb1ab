/*
 * timings_emit.c - the numbers, the messages and the timings of the parser (labial/timings.h).
 */
#include "timings_parts.h"

#include "labial/laugh.h"

/* Bytes of a text that a message shows. */
#define SHOWN 63u

/* ---- Texts ----------------------------------------------------------------------------------------------------- */

/* Adds `text` to the message, in one line: texts of a TextGrid may have line ends. There is room for three texts and
 * the longest pattern. */
static uint32_t message_add(labial_timings_t *t, uint32_t at, const char *text)
{
    uint32_t i;
    for (i = 0; text[i] && i < SHOWN; i++)
        t->message[at++] = (unsigned char)text[i] < 0x20u ? ' ' : text[i];
    return at;
}

int labial_timings_malformed(labial_timings_t *t, const char *pattern, const char *a, const char *b, const char *c)
{
    const char *texts[3];
    uint32_t at = 0, next = 0;
    char sign[2] = { 0, 0 };
    texts[0] = a;
    texts[1] = b;
    texts[2] = c;
    for (; *pattern; pattern++) {
        sign[0] = *pattern;
        at = message_add(t, at, *pattern == '%' ? texts[next++] : sign);
    }
    t->message[at] = '\0';
    return LABIAL_ERROR_TIMINGS;
}

int labial_timings_is_control(unsigned char byte)
{
    return (byte < 0x20u && byte != '\t' && byte != '\r' && byte != '\n') || byte == 0x7fu;
}

int labial_timings_not_text(labial_timings_t *t, unsigned char byte)
{
    static const char digits[] = "0123456789abcdef";
    char hex[3];
    hex[0] = digits[byte >> 4];
    hex[1] = digits[byte & 15u];
    hex[2] = '\0';
    return labial_timings_malformed(t, "byte 0x% is not text", hex, 0, 0);
}

const char *labial_timings_decimal(char text[21], uint64_t value)
{
    uint32_t count = 0, i;
    uint64_t rest = value;
    do {
        count++;
        rest /= 10u;
    } while (rest > 0u);
    text[count] = '\0';
    for (i = count; i > 0u; i--) {
        text[i - 1u] = (char)('0' + (int)(value % 10u));
        value /= 10u;
    }
    return text;
}

int labial_timings_is(const char *text, const char *word)
{
    for (; *text && *text == *word; text++)
        word++;
    return *text == *word;
}

int labial_timings_is_word(const char *text, const char *word)
{
    for (; *word; text++, word++)
        if (*text != *word && !(*text >= 'A' && *text <= 'Z' && *text - 'A' + 'a' == *word))
            return 0;
    return *text == '\0';
}

uint32_t labial_timings_length(const char *text)
{
    uint32_t length = 0;
    while (length < LABIAL_TIMINGS_FIELD_MAX && text[length]) /* both conditions, or compilers make it strlen() */
        length++;
    return length;
}

/* ---- Numbers --------------------------------------------------------------------------------------------------- */

static int decimal_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Exponents beyond this count as it: no field has so many digits. */
#define EXPONENT_MAX 100000

/* The parts of a number: how many digits it has, how many of them stand before the point, and its power of ten. */
typedef struct {
    const char *digits; /* with the point among them */
    int32_t count, before, exponent;
    int negative;
} parts_t;

/* Takes `text` apart by the one grammar of numbers; 0 when it is none. */
static int take_apart(const char *text, parts_t *number)
{
    number->before = 0;
    number->exponent = 0;
    number->negative = *text == '-';
    number->digits = text + number->negative;
    for (text = number->digits; decimal_digit(*text); text++)
        number->before++;
    number->count = number->before;
    if (*text == '.')
        for (text++; decimal_digit(*text); text++)
            number->count++;
    if (number->count == 0)
        return 0;
    if (*text == 'e' || *text == 'E') {
        const int below = text[1] == '-';
        text += below || text[1] == '+' ? 2 : 1;
        if (!decimal_digit(*text))
            return 0;
        for (; decimal_digit(*text); text++)
            if (number->exponent < EXPONENT_MAX)
                number->exponent = number->exponent * 10 + (*text - '0');
        if (below)
            number->exponent = -number->exponent;
    }
    return *text == '\0';
}

int labial_timings_read(const char *text, unsigned places, uint64_t maximum, uint64_t *value)
{
    parts_t number;
    uint64_t sum = 0;
    uint32_t carry = 0, other_than_zero = 0;
    int32_t i = 0, taken; /* digits that the result has */
    const char *c;
    if (!take_apart(text, &number))
        return 0;
    taken = number.before + number.exponent + (int32_t)places;
    for (c = number.digits; i < number.count; c++) {
        if (*c == '.')
            continue;
        other_than_zero |= *c != '0';
        if (i < taken)
            sum = sum * 10u + (uint64_t)(*c - '0');
        else if (i == taken)
            carry = *c >= '5';
        if (sum > maximum)
            return 0;
        i++;
    }
    for (; i < taken && sum > 0u; i++) {
        sum *= 10u;
        if (sum > maximum)
            return 0;
    }
    *value = sum + carry;
    return *value <= maximum && !(number.negative && other_than_zero);
}

int labial_timings_is_whole(const char *text)
{
    while (decimal_digit(*text))
        text++;
    return *text == '\0';
}

int labial_timings_is_number(const char *text)
{
    parts_t number;
    return take_apart(text, &number);
}

/* ---- Timings --------------------------------------------------------------------------------------------------- */

/* Reads an intensity from 0 to 1, and removes the `>` that ends it; nothing may follow. */
static int read_intensity(labial_timings_t *t, char *text, int16_t *intensity)
{
    const uint32_t length = labial_timings_length(text);
    uint64_t millionths;
    if (length < 2u || text[length - 1u] != '>')
        return labial_timings_malformed(t, "'%' is not an intensity from 0 to 1 and '>'", text, 0, 0);
    text[length - 1u] = '\0';
    if (!labial_timings_read(text, 6, 1000000u, &millionths))
        return labial_timings_malformed(t, "the intensity '%' of a laugh is not from 0 to 1", text, 0, 0);
    text[length - 1u] = '>';
    *intensity = (int16_t)(((uint32_t)millionths * LABIAL_LAUGH_FULL + 500000u) / 1000000u);
    return LABIAL_OK;
}

static int hand_on(labial_timings_t *t, const char *label, int16_t laugh, uint64_t start, uint64_t end)
{
    if (end > LABIAL_TIMINGS_TIME_MAX)
        return labial_timings_malformed(t, "'%' ends later than 1000000 seconds", label ? label : "<laugh>", 0, 0);
    t->end = end > t->end ? end : t->end;
    t->found.start = start;
    t->found.end = end;
    t->found.label = label;
    t->found.word = 0;
    t->found.line = t->line;
    t->found.laugh = laugh;
    t->found.has_apex = 0;
    t->found.xsampa = t->format == LABIAL_TIMINGS_PHO || t->format == LABIAL_TIMINGS_MARY;
    return LABIAL_OK;
}

int labial_timings_emit(labial_timings_t *t, char *label, uint64_t start, uint64_t end)
{
    static const char laugh[] = "<laugh";
    int16_t intensity = -1;
    uint32_t i;
    if (start + LABIAL_TIMINGS_TOLERANCE < t->end) {
        char seconds[21], millionths[21];
        labial_timings_decimal(seconds, start / 1000000000u);
        labial_timings_decimal(millionths, 1000000u + start / 1000u % 1000000u);
        millionths[0] = '.';
        return labial_timings_malformed(t, "'%' starts at %% s, before the phoneme before it ends", label ? label : "",
                                        seconds, millionths);
    }
    if (!label)
        return hand_on(t, label, -1, start, end);
    for (i = 0; laugh[i] && label[i] == laugh[i]; i++)
        ;
    if (!laugh[i] && (label[i] == ':' || label[i] == ' ')) {
        const int result = read_intensity(t, label + i + 1u, &intensity);
        if (result != LABIAL_OK)
            return result;
    } else if (!laugh[i] && labial_timings_is(label + i, ">")) {
        intensity = LABIAL_LAUGH_FULL / 2;
    }
    if (labial_timings_length(label) > LABIAL_TIMINGS_LABEL_MAX)
        return labial_timings_malformed(t, "the label '%...' is longer than 63 bytes", label, 0, 0);
    return hand_on(t, label, intensity, start, end);
}

int labial_timings_emit_marker(labial_timings_t *t)
{
    char *last = t->fields[t->count - 1u];
    uint64_t duration;
    int16_t intensity = LABIAL_LAUGH_FULL / 2;
    if (t->count == 3u) {
        const int result = read_intensity(t, last, &intensity);
        if (result != LABIAL_OK)
            return result;
    } else {
        last[labial_timings_length(last) - 1u] = '\0';
    }
    if (!labial_timings_read(t->fields[1], LABIAL_SECOND, LABIAL_TIMINGS_TIME_MAX, &duration))
        return labial_timings_malformed(t, "'%' is not the duration of a laugh in seconds", t->fields[1], 0, 0);
    t->origin += duration;
    return hand_on(t, 0, intensity, t->end, t->end + duration);
}
