/*
 * test_words_time.c - words in time (labial/words.h): shares of phonemes against the exporter's reference, pauses,
 * bridged gaps, offsets, characters.
 */
#include "suite.h"
#include "labial/words.h"
#include "words_cases.h"
#include "words_en.h"

/* Phonemes and their milliseconds, as they come. */
typedef struct {
    unsigned count;
    unsigned phonemes[1300];
    uint32_t lasts[1300];
} spoken_t;

static labial_words_t stream;
static spoken_t spoken;

static void begin(int32_t offset)
{
    memset(&stream, 0xa5, sizeof stream);
    memset(&spoken, 0, sizeof spoken);
    assert_ok(labial_words_init(&stream, &words_en, NULL, offset));
}

/* Takes all phonemes that there are; returns what the last call did. */
static int take_all(void)
{
    for (;;) {
        unsigned phoneme = 77;
        uint32_t milliseconds = 0;
        const int result = labial_words_next(&stream, &phoneme, &milliseconds);
        if (result != LABIAL_OK)
            return result;
        assert_in_range(milliseconds, 1, LABIAL_DURATION_MAX);
        assert_true(spoken.count < 1300);
        spoken.phonemes[spoken.count] = phoneme;
        spoken.lasts[spoken.count++] = milliseconds;
    }
}

/* Says a word and takes what comes of it. */
static void say(const char *text, uint32_t start, uint32_t end)
{
    assert_ok(labial_words_push(&stream, text, strlen(text), start, end));
    assert_true(take_all() >= LABIAL_WAITING);
}

static void flush(void)
{
    assert_ok(labial_words_end(&stream));
    assert_int_equal(take_all(), LABIAL_DONE);
    assert_ok(labial_words_restart(&stream));
}

/* A word with the ends of its characters, alone. */
static void say_characters(const char *text, uint32_t start, const uint32_t *ends)
{
    assert_ok(labial_words_push_characters(&stream, text, strlen(text), start, ends, (unsigned)strlen(text)));
    flush();
}

/* The end of the first `count` phonemes that were spoken, and of all. */
static uint32_t until(unsigned count)
{
    uint32_t sum = 0;
    for (unsigned i = 0; i < count; i++)
        sum += spoken.lasts[i];
    return sum;
}

static uint32_t until_now(void)
{
    return until(spoken.count);
}

/* What was spoken must be these phonemes. */
static void expect_phonemes(const uint8_t *expected, size_t count)
{
    assert_int_equal(spoken.count, count);
    for (unsigned i = 0; i < spoken.count; i++)
        assert_int_equal(spoken.phonemes[i], expected[i]);
}

/* Steps with "; " between them: a word with its times, "hello 100-400", "end" with all that is left, or "= 400", where what
 * was spoken must end. */
static void follow(const char *steps)
{
    for (; *steps; steps += strcspn(steps, ";"), steps += *steps ? 2 : 0) {
        char word[16];
        unsigned long start = 0, end = 0;
        const int found = sscanf(steps, "%15[^ ;] %lu-%lu", word, &start, &end);
        if (found == 3)
            say(word, (uint32_t)start, (uint32_t)end);
        else if (found == 2)
            assert_int_equal(until_now(), start);
        else
            flush();
    }
}

/* Would catch a wrong duration, a factor that is left out or holds elsewhere, and rounding that moves a word's end. */
TEST(words_share_their_time_as_by_the_reference)
{
    unsigned k, next;
    for (unsigned i = 0; i < COUNT_OF(timed); i++) {
        labial_word_t word;
        begin(0);
        say(timed[i].text, 0, timed[i].length);
        if (!timed[i].pause)
            say("a", timed[i].length, timed[i].length);
        else
            flush();
        assert_ok(labial_words_read(&words_en, NULL, timed[i].text, strlen(timed[i].text), &word));
        for (next = k = 0; k < word.count; k++) {
            if (timed[i].lasts[k] == 0)
                continue;
            assert_int_equal(spoken.phonemes[next], word.phonemes[k].phoneme);
            assert_int_equal(spoken.lasts[next], timed[i].lasts[k]);
            next++;
        }
        assert_int_equal(spoken.count, next);
    }
}

/* Would catch a pause at a comma through which the word before it is drawn out, and gaps that every word has. */
TEST(gaps_behind_punctuation_are_pauses_sooner)
{
    static const char *const texts[] = { "hello,",        "hello.",         "hello!\"", "hello?)", "hello;'",
                                         "hello: ",       "hello,]",        "hello।",   "hello؟",  "hello,”",
                                         "hello！",       "hello।)",        "hello",    "hel,lo",  "hello-",
                                         "hello\xc3\xa9", "hello,\xcc\x81", "hello”",   "hel।lo" };
    for (unsigned i = 0; i < COUNT_OF(texts); i++) {
        for (uint32_t gap = 79; gap <= 80; gap++) {
            begin(0);
            say(texts[i], 100, 400);
            say("world", 400 + gap, 800);
            assert_int_equal(until_now(), i < 12 && gap == 80 ? 400 : 400 + gap);
        }
    }
    begin(0);
    say("hello", 100, 400);
    say(",", 410, 410); /* told by itself */
    say("'\"", 410, 410);
    say("\x80\x80", 410, 410); /* no UTF-8 */
    say("world", 500, 800);
    assert_int_equal(until_now(), 400);
}

/* Would catch time that is lost or invented: whatever the words, the phonemes lie between their times. */
TEST(phonemes_keep_the_words_times)
{
    begin(0);
    say("hello", 100, 400);
    assert_int_equal(spoken.count, 0);
    follow("world 549-800; = 549"); /* a gap of 149 ms belongs to the word before it */
    assert_int_equal(spoken.phonemes[0], 0);
    assert_int_equal(spoken.lasts[0], 100);
    follow("now 950-1200; = 800"); /* one of 150 ms is silence */
    const unsigned second = spoken.count;
    follow("end; = 1200");
    assert_int_equal(spoken.phonemes[second], 0);
    assert_int_equal(spoken.lasts[second], 150);
    follow("again 1300-1600; end; = 1600; end; = 1600"); /* a flush is not the end */
}

/* Would catch phonemes that are said twice where the next word takes them, and a context that survives an end. */
TEST(a_word_takes_phonemes_from_the_one_before)
{
    static const uint8_t expected[] = { 14, 6, 35, 22, 17, 21, 37, 3, 23, 9, 1, 21, 12, 38 }; /* five million dollars */
    begin(0);
    follow("$5 0-300; million 300-900; end; = 900");
    expect_phonemes(expected, sizeof expected);
    assert_int_equal(until(3), 300);
    spoken.count = 0;
    follow("$5 900-1200; end; million 1200-1500; end");
    assert_int_equal(spoken.count, 8 + 6);
}

/* Would catch a number that is said beside its ordinal, and time that neither of the two words gets. */
TEST(a_word_takes_all_phonemes_of_the_one_before)
{
    static const uint8_t expected[] = { 0, 14, 17, 14, 32, 22, 1, 28, 8 }; /* fifth march */
    static const uint32_t ends[] = { 500, 550, 600, 700, 800 };
    for (unsigned round = 0; round < 2u; round++) {
        begin(0);
        say("5", 100, 400);
        if (round == 0u)
            say("March", 400, 800);
        else
            assert_ok(labial_words_push_characters(&stream, "March", 5, 400, ends, 5));
        flush();
        expect_phonemes(expected, sizeof expected);
        for (unsigned i = 1; i < spoken.count; i++)
            assert_true(spoken.lasts[i] >= 40u);
        assert_int_equal(until(1), 100);
        assert_int_equal(until_now(), 800);
    }
}

/* Would catch a word that runs into the next one, one without time that is spoken nevertheless, and one that goes back in
 * time behind a flush. */
TEST(a_word_ends_where_the_next_begins)
{
    begin(0);
    follow("hello 0-900; my 500-700; = 500; own 500-600; = 500; end; = 600");
    follow("my 500-550; end; = 600; own 500-700; end; = 700");
}

/* Would catch a word of unknown end that lasts through a pause, or that is cut short. */
TEST(ends_that_are_not_known_are_guessed)
{
    labial_word_t word;
    uint32_t length, slow;
    unsigned count;
    assert_ok(labial_words_read(&words_en, NULL, "banana", 6, &word));
    length = labial_words_length(&words_en, &word);
    assert_in_range(length, 300, 700);
    begin(0);
    say("banana", 0, LABIAL_WORDS_NO_END);
    say("banana", length / 2, LABIAL_WORDS_NO_END); /* spoken fast */
    assert_int_equal(until_now(), length / 2);
    slow = length / 2 + length / 4 * 6;
    say("banana", slow, LABIAL_WORDS_NO_END); /* slowly: one and a half times */
    assert_int_equal(until_now(), slow);
    say("banana", 10 * length, LABIAL_WORDS_NO_END); /* and before a pause */
    assert_int_equal(until_now(), slow + length);
    count = spoken.count;
    say(".", 10 * length + 222, LABIAL_WORDS_NO_END); /* punctuation tells where it ends */
    flush();
    assert_int_equal(spoken.phonemes[count], 0);
    assert_int_equal(until_now(), 10 * length + 222);
    say("banana", 20 * length, LABIAL_WORDS_NO_END);
    say(".", 20 * length, LABIAL_WORDS_NO_END); /* but not with the word */
    flush();
    assert_int_equal(until_now(), 21 * length);
    for (unsigned longer = 0; longer < 2; longer++) { /* one and a half times is the most */
        begin(0);
        memset(&spoken, 0, sizeof spoken);
        say("banana", 0, LABIAL_WORDS_NO_END);
        say("banana", length / 4 * 6 + longer, LABIAL_WORDS_NO_END);
        assert_int_equal(until_now(), longer ? length : length / 4 * 6);
    }
    say("banana", 0xfffffff0u, LABIAL_WORDS_NO_END); /* hours of silence, in parts */
    flush();
    assert_int_equal(until_now(), 0xffffffffu);
}

TEST(words_of_no_length_have_no_known_end)
{
    static const uint32_t ends[5] = { 500, 500, 500, 500, 500 };
    static spoken_t open;
    begin(0);
    say("hello", 500, LABIAL_WORDS_NO_END);
    say("shake", 700, LABIAL_WORDS_NO_END);
    flush();
    open = spoken;
    begin(0);
    follow("hello 500-500; shake 700-700; end");
    assert_memory_equal(&spoken, &open, sizeof open);
    assert_in_range(until_now(), 900, 1300);
    begin(0);
    say("shake", 500, LABIAL_WORDS_NO_END);
    flush();
    open = spoken;
    begin(0);
    say_characters("shake", 500, ends);
    assert_memory_equal(&spoken, &open, sizeof open);
}

/* Would catch silent texts that cut or lengthen words whose ends are known. */
TEST(silent_texts_leave_their_time)
{
    begin(0);
    follow("[sighs] 0-300; no 400-600; ! 500-650; end; = 600");
    assert_int_equal(spoken.lasts[0], 400);
}

/* Would catch an unknown word that closes the lips, or lasts otherwise than it is told. */
TEST(unknown_words_move_the_lips)
{
    begin(0);
    follow("\xd0\xbf\xd1\x80 0-700; end; = 700");
    assert_int_equal(spoken.count, 4);
    for (unsigned i = 0; i < spoken.count; i++) {
        assert_string_equal(labial_words_label(&words_en, spoken.phonemes[i]), i % 2 ? "L" : "AH");
        assert_in_range(spoken.lasts[i], 100, 225);
    }
    say("\xd0\xbf\xd1\x80", 800, LABIAL_WORDS_NO_END);
    follow("end; = 1100; \xd0\xbf\xd1\x80 1100-1110; end; = 1110");
}

/* Would catch an offset that is added twice or to one end alone, and times that wrap below zero or beyond the last. */
TEST(offsets_move_all_words)
{
    static const struct {
        int32_t offset;
        uint32_t start, end, silence, last;
    } cases[] = {
        { 70, 100, 300, 170, 370 },    { -70, 100, 300, 30, 230 },
        { -200, 100, 300, 0, 100 },    { -400, 100, 300, 0, 0 },
        { INT32_MIN, 100, 300, 0, 0 }, { INT32_MAX, 0xf0000000u, 0xf0000010u, 0xffffffffu, 0xffffffffu },
    };
    for (unsigned i = 0; i < COUNT_OF(cases); i++) {
        unsigned silent = 0;
        begin(cases[i].offset);
        say("hello", cases[i].start, cases[i].end);
        flush();
        while (silent < spoken.count && spoken.phonemes[silent] == 0)
            silent++;
        assert_int_equal(until(silent), cases[i].silence);
        assert_int_equal(until_now(), cases[i].last);
    }
}

/* Says "shake" with the ends of its characters, and tells where its phonemes SH, EY and K end. */
static void shake(const uint32_t ends[5], uint32_t found[3])
{
    begin(0);
    say_characters("shake", 0, ends);
    assert_int_equal(spoken.count, 3);
    for (unsigned i = 0; i < 3; i++)
        found[i] = until(i + 1);
}

/* Would catch characters that do not count, count alone, or count where they only share out the word's time. */
TEST(characters_move_boundaries_half_way)
{
    static const uint32_t even[5] = { 100, 200, 300, 400, 500 }, late[5] = { 200, 300, 350, 400, 500 },
                          nearly[5] = { 100, 205, 300, 405, 500 };
    uint32_t plain[3], found[3];
    shake(even, plain);
    shake(nearly, found);
    assert_memory_equal(found, plain, sizeof found);
    shake(late, found); /* s and h to 300 ms, a to 350, k and e to 500 */
    assert_in_range(found[0], (plain[0] + 300) / 2 - 1, (plain[0] + 300) / 2 + 1);
    assert_in_range(found[1], (plain[1] + 350) / 2 - 1, (plain[1] + 350) / 2 + 1);
    assert_int_equal(found[2], 500);
}

/* Would catch a share of a character's time that is counted from the word's beginning: where K ends in "box", whose x
 * lasts from 200 to 600 ms. Its share of the x is that of a box of ten minutes, which is said without characters. */
TEST(a_characters_phonemes_begin_with_it)
{
    static const uint32_t box[3] = { 100, 200, 600 };
    begin(0);
    say("box", 0, 600000);
    say("a", 600000, 600000);
    const uint32_t within = 200u + 400u * (spoken.lasts[2] / 100u) / (spoken.lasts[2] / 100u + spoken.lasts[3] / 100u);
    begin(0);
    say("box", 0, 600);
    flush();
    const uint32_t wanted = (until(3) + within) / 2u;
    begin(0);
    say_characters("box", 0, box);
    assert_in_range(until(3), wanted - 1u, wanted + 1u);
}

/* Would catch phonemes of one character that do not share its time, silent letters at the beginning that take it, and
 * words that are longer than a place can say. */
TEST(characters_of_several_phonemes_share_their_time)
{
    static const uint32_t box[3] = { 100, 200, 600 }, knee[4] = { 400, 500, 600, 700 }, slow[2] = { 90000, 100000 };
    begin(0);
    say_characters("box", 0, box); /* B AA K S: the x has K and S */
    assert_int_equal(spoken.count, 4);
    assert_in_range(until(3), 290, 460);
    assert_int_equal(until(4), 600);
    begin(0);
    say_characters("knee", 0, knee);
    assert_int_equal(spoken.count, 2);
    assert_in_range(until(1), 300, 420); /* N has the k's time, too */
    begin(0);
    say_characters("go", 0, slow);
    assert_int_equal(until(2), 100000);
    begin(-200); /* the word begins before the sound, and loses a part */
    say_characters("box", 0, box);
    assert_int_equal(until_now(), 400);
}

TEST(characters_must_be_in_order)
{
    static const uint32_t ends[3] = { 100, 90, 300 }, open[1] = { LABIAL_WORDS_NO_END };
    uint32_t same[256];
    for (unsigned i = 0; i < 256; i++)
        same[i] = 500;
    begin(0);
    assert_int_equal(labial_words_push_characters(&stream, "box", 3, 0, ends, 3), LABIAL_ERROR_WORD);
    assert_int_equal(labial_words_push_characters(&stream, "box", 3, 101, ends, 1), LABIAL_ERROR_WORD);
    assert_int_equal(labial_words_push_characters(&stream, "box", 3, 0, ends, 0), LABIAL_ERROR_WORD);
    assert_int_equal(labial_words_push_characters(&stream, "box", 3, 0, ends, 1), LABIAL_ERROR_WORD);
    assert_int_equal(labial_words_push_characters(&stream, "a", 1, 0, open, 1), LABIAL_ERROR_WORD);
    assert_int_equal(labial_words_push_characters(&stream, "box", 3, 0, same, 256), LABIAL_ERROR_WORD);
    assert_int_equal(labial_words_push_characters(&stream, "box", 3, 0, NULL, 3), LABIAL_ERROR_NULL);
    assert_ok(labial_words_push_characters(&stream, "box", 3, 500, same, 3));
}

/* Would catch a word after the end, phonemes that the end or a cancel leaves behind, and times that begin anew. */
TEST(words_end_and_go_on)
{
    begin(0);
    assert_int_equal(labial_words_restart(&stream), LABIAL_ERROR_STATE); /* they have not ended */
    say("me", 100, 300);
    labial_latency_t latency = labial_words_latency(&stream);
    assert_true(latency.milliseconds == 300 && latency.phonemes == 2 && latency.frames == 0 && latency.delay == 0);
    assert_ok(labial_words_push(&stream, "box", 3, 300, 700));
    assert_ok(labial_words_end(&stream)); /* before anything was taken */
    assert_ok(labial_words_end(&stream));
    latency = labial_words_latency(&stream);
    assert_true(latency.milliseconds == 700 && latency.phonemes == 6);
    assert_int_equal(labial_words_push(&stream, "me", 2, 800, 900), LABIAL_ERROR_STATE);
    assert_int_equal(labial_words_restart(&stream), LABIAL_ERROR_STATE); /* there are phonemes to be taken */
    follow("end; = 700; me 900-1000; box 1000-1300; = 1000");
    assert_ok(labial_words_cancel(&stream));
    latency = labial_words_latency(&stream);
    assert_true(latency.milliseconds == 0 && latency.phonemes == 0);
    assert_int_equal(labial_words_push(&stream, "me", 2, 1000, 1100), LABIAL_ERROR_STATE);
    follow("end; = 1000; me 950-1200; end; = 1200"); /* before what was dropped, and in part before what was taken */
}

/* Would catch a word that is counted twice or not at all while it is spoken, and a restart in the midst of one. */
TEST(latency_tells_what_is_inside)
{
    static const char *const texts[] = { "banana", "\xd0\x9f" }; /* read, and in letters that are not known */
    labial_latency_t latency;
    unsigned phoneme;
    uint32_t lasts;
    for (unsigned i = 0; i < 2; i++) {
        unsigned before;
        begin(0);
        assert_ok(labial_words_pronounce(&stream, NULL));
        assert_ok(labial_words_push(&stream, texts[i], strlen(texts[i]), 0, 900));
        assert_ok(labial_words_push(&stream, "me", 2, 900, LABIAL_WORDS_NO_END));
        latency = labial_words_latency(&stream);
        assert_int_equal(latency.milliseconds, 900); /* nobody knows how long the open word lasts */
        before = latency.phonemes;
        assert_ok(labial_words_next(&stream, &phoneme, &lasts));
        latency = labial_words_latency(&stream);
        assert_true(latency.phonemes < before && latency.milliseconds == 900 - lasts);
        assert_ok(labial_words_end(&stream));
        assert_int_equal(take_all(), LABIAL_DONE);
        assert_int_equal(labial_words_latency(&stream).phonemes, 0);
    }
    begin(0);
    assert_ok(labial_words_push(&stream, "me", 2, 0, 300));
    assert_ok(labial_words_end(&stream));
    assert_ok(labial_words_next(&stream, &phoneme, &lasts));
    assert_int_equal(labial_words_restart(&stream), LABIAL_ERROR_STATE);
    assert_ok(labial_words_next(&stream, &phoneme, &lasts));
    assert_ok(labial_words_restart(&stream));
    assert_ok(labial_words_push(&stream, "me", 2, 300, 600)); /* the first one takes no room */
}

/* Would catch a word of the caller's that is read before its beginning, and a division by weights that are all zero. */
TEST(words_and_models_without_sense_do_no_harm)
{
    static const uint8_t nothing[256] = { 0 };
    static const uint32_t ends[] = { 10, 50, 400 };
    labial_words_model_t still = words_en;
    labial_word_t word;
    uint32_t length, lasts;
    unsigned phoneme;
    assert_ok(labial_words_read(&words_en, NULL, "me", 2, &word));
    length = labial_words_length(&words_en, &word);
    assert_true(length > 100 && word.phonemes[0].first);
    word.phonemes[0].first = 0;
    assert_int_equal(labial_words_length(&words_en, &word), length);
    still.milliseconds = nothing;
    assert_ok(labial_words_init(&stream, &still, NULL, 0));
    assert_ok(labial_words_push_characters(&stream, "box", 3, 0, ends, 3));
    assert_ok(labial_words_end(&stream));
    assert_int_equal(labial_words_next(&stream, &phoneme, &lasts), LABIAL_DONE);
}

TEST(misuse_is_an_error)
{
    labial_words_model_t other = words_en;
    static const uint32_t ends[] = { 1 };
    labial_words_t none;
    unsigned phoneme;
    uint32_t milliseconds;
    memset(&none, 0, sizeof none);
    other.format++;
    assert_int_equal(labial_words_init(NULL, &words_en, NULL, 0), LABIAL_ERROR_NULL);
    assert_int_equal(labial_words_init(&none, NULL, NULL, 0), LABIAL_ERROR_NULL);
    assert_int_equal(labial_words_init(&none, &other, NULL, 0), LABIAL_ERROR_VERSION);
    for (unsigned i = 0; i < 2; i++) {
        labial_words_t *const bad = i ? &none : NULL;
        const int error = i ? LABIAL_ERROR_STATE : LABIAL_ERROR_NULL;
        assert_int_equal(labial_words_push(bad, "a", 1, 0, 1), error);
        assert_int_equal(labial_words_push_characters(bad, "a", 1, 0, ends, 1), error);
        assert_int_equal(labial_words_end(bad), error);
        assert_int_equal(labial_words_cancel(bad), error);
        assert_int_equal(labial_words_pronounce(bad, NULL), error);
        assert_int_equal(labial_words_restart(bad), error);
        assert_int_equal(labial_words_next(bad, &phoneme, &milliseconds), error);
        assert_int_equal(labial_words_latency(bad).milliseconds, 0);
    }
    assert_int_equal(labial_words_length(NULL, &none.spans[0].word), 0);
    assert_int_equal(labial_words_length(&words_en, NULL), 0);
    begin(0);
    assert_int_equal(labial_words_next(&stream, NULL, &milliseconds), LABIAL_ERROR_NULL);
    assert_int_equal(labial_words_next(&stream, &phoneme, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_words_next(&stream, &phoneme, &milliseconds), LABIAL_WAITING);
    assert_int_equal(labial_words_push(&stream, NULL, 1, 0, 1), LABIAL_ERROR_NULL);
    assert_int_equal(labial_words_push(&stream, "a", 1, 2, 1), LABIAL_ERROR_WORD);
    assert_int_equal(labial_words_push(&stream, "a", 1, 0, LABIAL_DURATION_MAX + 1), LABIAL_ERROR_DURATION);
    assert_ok(labial_words_push(&stream, "a", 1, 10, 10 + LABIAL_DURATION_MAX));
    assert_int_equal(labial_words_next(&stream, &phoneme, &milliseconds), LABIAL_WAITING);
    assert_int_equal(labial_words_push(&stream, "a", 1, 9, 20), LABIAL_ERROR_WORD);
    assert_ok(labial_words_push(&stream, "a", 1, 149 + LABIAL_DURATION_MAX, LABIAL_WORDS_NO_END));
    assert_int_equal(labial_words_push(&stream, "a", 1, 149 + LABIAL_DURATION_MAX, LABIAL_WORDS_NO_END),
                     LABIAL_ERROR_FULL);
    assert_int_equal(take_all(), LABIAL_WAITING);
    assert_int_equal(until_now(), 149 + LABIAL_DURATION_MAX);
    assert_int_equal(labial_words_push(&stream, "a", 1, 9, 20), LABIAL_ERROR_WORD);
}

SUITE(NULL, NULL)
