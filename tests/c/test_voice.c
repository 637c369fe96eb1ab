/*
 * test_voice.c - a voice that is followed (labial/voice.h): its rules by cases worked out by hand, its frames against a
 * stream that is given everything at once, and drawn messages that are rounded, doubled, shuffled and stale.
 * tests/voices/oracle.py compares whole sessions.
 */
#include "suite.h"
#include "labial/voice.h"
#include "laughter_synthetic.h"
#include "speech_en.h"
#include "voice_parts.h"
#include "words_en.h"

enum { PLACES = 600, MS = 1000 };

static labial_voice_t voice;
static uint32_t memory[LABIAL_VOICE_SIZE(3, 8, PLACES) / 4];
static labial_voice_item_t items[PLACES];
static labial_voice_message_t message;
static char said[4000];
static int64_t plan_from; /* where known() begins */

static void begin_with(unsigned places)
{
    memset(memory, 0xa5, sizeof memory);
    assert_ok(labial_voice_init(&voice, &speech_en, memory, LABIAL_VOICE_SIZE(3, 8, places)));
    assert_ok(labial_voice_words(&voice, &words_en, NULL));
    memset(&message, 0, sizeof message);
    message.items = items;
}

SETUP(begin)
{
    begin_with(PLACES);
    plan_from = 0;
    return 0;
}

/* A new voice, which is told items of this kind. */
static void begin_of(unsigned kind)
{
    begin_with(PLACES);
    message.kind = (uint8_t)kind;
}

static uint32_t name(const char *text)
{
    return labial_voice_identity(text, strlen(text));
}

/* An item of the message, milliseconds; a negative end is not known. */
static void item(const char *text, int64_t start, int64_t end)
{
    labial_voice_item_t *const one = &items[message.count++];
    memset(one, 0, sizeof *one);
    one->start = (uint64_t)(start * MS);
    one->end = end < 0 ? LABIAL_VOICE_NO_END : (uint64_t)(end * MS);
    if (message.kind == LABIAL_VOICE_PHONEMES) {
        while (one->phoneme < 39u && strcmp(labial_words_label(&words_en, one->phoneme), text) != 0)
            one->phoneme++;
    } else {
        one->text = text;
        one->size = (uint16_t)strlen(text);
    }
}

static int tell(void)
{
    const int result = labial_voice_tell(&voice, &message);
    message.count = 0;
    return result;
}

/* The last item of a message, or the only one. */
static void tell_one(const char *text, int64_t start, int64_t end)
{
    item(text, start, end);
    assert_ok(tell());
}

/* The items of a message, written as known() writes them; an end may be left out. */
static void items_of(const char *text)
{
    while (*text) {
        char *at, label[4] = "";
        const long start = strtol(text, &at, 10), end = at[1] == ' ' ? -1 : strtol(at + 1, &at, 10);
        at += end < 0 ? 2 : 1;
        memcpy(label, at, strcspn(at, ","));
        item(label, start, end);
        text = at + strcspn(at, ",");
        text += *text ? 2 : 0;
    }
}

/* A message of texts, the last of which is null, one every `step` milliseconds. */
static void tell_texts(int64_t start, int64_t step, const char *const *texts)
{
    for (; *texts; texts++, start += step)
        item(*texts, start, -1);
    assert_ok(tell());
}

/* The characters of a text of UTF-8, 50 ms each. */
static void characters(const char *text, int64_t start)
{
    static char found[PLACES][5];
    for (unsigned i = 0; *text; i++, text += labial_voice_bytes(text, 5)) {
        memset(found[i], 0, sizeof found[i]);
        memcpy(found[i], text, labial_voice_bytes(text, 5));
        item(found[i], start + 50 * i, start + 50 * (i + 1));
    }
}

/* What is known, without silences: "100-170 M, 170-300 EY". */
static const char *known(void)
{
    labial_voice_segment_t segment;
    int64_t end = plan_from;
    size_t size = 0;
    *said = '\0';
    labial_voice_plan_start(&voice, plan_from);
    for (;;) {
        labial_voice_plan_next(&voice, &segment);
        assert_true(segment.start == end && segment.end > segment.start);
        if (segment.end == INT64_MAX)
            break;
        end = segment.end;
        if (segment.phoneme != SPEECH_EN_SIL)
            size += (size_t)snprintf(said + size, sizeof said - size, "%s%ld-%ld %s", size > 0 ? ", " : "",
                                     (long)segment.start, (long)segment.end,
                                     labial_words_label(&words_en, segment.phoneme));
        assert_true(size < sizeof said - 40);
    }
    voice.stale = voice.changed = 1;
    return said;
}

#define assert_known(wanted) assert_string_equal(known(), wanted)

/* Plays every frame up to a time. */
static void play(uint64_t until)
{
    int16_t faps[LABIAL_CHANNELS];
    for (uint64_t heard = 20u * (uint64_t)voice.next; heard <= until; heard += 20)
        assert_ok(labial_voice_next(&voice, heard, NULL, faps));
}

static void show_until(unsigned milliseconds);
static void tell_sentence(unsigned from, unsigned to);

/* One step: "begin 1000 a" or "begin a", behind the one before, "play 600", "show 600", "cancel 100", "finish", "done",
 * "not done", "sentence", which is all of it, or the message "a: 0-500 M, 500-700 AA". Names may be left out. What should not be accepted is "dropped a: ..." or
 * "full a: ...". */
static void take_step(const char *step)
{
    unsigned long time = 0;
    char who[8] = "";
    if (strncmp(step, "begin", 5) == 0) {
        const int has_time = sscanf(step, "begin %lu %7s", &time, who) > 0;
        if (!has_time)
            (void)sscanf(step, "begin %7s", who);
        assert_ok(labial_voice_begin(&voice, has_time ? time : LABIAL_VOICE_BEHIND, *who ? name(who) : 0));
    } else if (sscanf(step, "play %lu", &time) > 0) {
        play(time);
    } else if (sscanf(step, "show %lu", &time) > 0) {
        show_until((unsigned)time);
    } else if (strcmp(step, "sentence") == 0) {
        tell_sentence(0, 100);
    } else if (sscanf(step, "cancel %lu", &time) > 0) {
        assert_ok(labial_voice_cancel(&voice, (uint32_t)time));
    } else if (strcmp(step, "finish") == 0) {
        assert_ok(labial_voice_finish(&voice));
    } else if (strstr(step, "done")) {
        assert_int_equal(labial_voice_done(&voice), step[0] == 'd');
    } else {
        const int wanted = strncmp(step, "dropped ", 8) == 0 ? LABIAL_CANCELLED
                           : strncmp(step, "full ", 5) == 0  ? LABIAL_ERROR_FULL
                                                             : LABIAL_OK;
        step += wanted == LABIAL_OK ? 0 : strcspn(step, " ") + 1;
        message.utterance = step[1] == ':' ? labial_voice_identity(step, 1) : 0;
        items_of(step[1] == ':' ? step + 3 : step);
        assert_int_equal(tell(), wanted);
    }
}

/* Steps with "; " between them. */
static void follow(const char *steps)
{
    while (*steps) {
        char step[120];
        const size_t size = strcspn(steps, ";");
        assert_true(size < sizeof step);
        memcpy(step, steps, size);
        step[size] = '\0';
        take_step(step);
        steps += size + (steps[size] ? 2 : 0);
    }
}

#define assert_follows(steps, wanted) assert_string_equal((follow(steps), known()), wanted)

TEST_AFTER(begin, phonemes_touch_within_their_gap)
{
    assert_follows("0-100 M; 101-200 AA; 199-300 B; 302-400 IY", /* rounding, either way */
                   "0-101 M, 101-200 AA, 200-300 B, 302-400 IY");
    message.gap = 50;
    follow("450-500 S; 500-520 S, 570-600 AA, 651-700 S, 690-702 T, 701-710 S, 705-720 AA");
    assert_follows("719-719 AA", /* cuts the one before by no more than rounding does */
                   "0-101 M, 101-200 AA, 200-300 B, 302-400 IY, 450-500 S, 500-570 S, 570-600 AA, "
                   "651-690 S, 690-702 T, 702-705 S, 705-720 AA");
}

TEST_AFTER(begin, a_message_replaces_what_was_told_of_its_time)
{
    assert_follows("0-9 M; 15-18 AA; 16-20 B; 15- F, 10-12 S", /* in any order */
                   "0-10 M, 10-12 S, 15-16 F, 16-20 B");
    assert_follows("0-500 IY", "0-500 IY");
}

TEST_AFTER(begin, visemes_last_until_the_next)
{
    message.kind = LABIAL_VOICE_AZURE;
    tell_texts(0, 100, (const char *const[]){ "8", "4", "6", "19", "16", "7", "2", "7", "7", "21", NULL });
    assert_known("0-200 OW, 200-300 IH, 300-500 CH, 500-600 W, 600-700 AA, 700-800 UW, 800-900 UW, "
                 "900-1000 P");
    plan_from = 450; /* within a pair, and behind what it depends on */
    assert_known("450-500 CH, 500-600 W, 600-700 AA, 700-800 UW, 800-900 UW, 900-1000 P");
    for (plan_from = 0; plan_from < 1000; plan_from += 50) /* from everywhere the same */
        assert_non_null(strstr(known(), "900-1000 P") ? said : strstr(said, "950-1000 P"));
    plan_from = 0;
    tell_texts(1000, 100, (const char *const[]){ "4", "1", NULL });
    assert_non_null(strstr(known(), "1000-1100 EH, 1100-1200 AH"));
    tell_texts(0, 0, (const char *const[]){ "22", "", "01", "123", "1a", "-", NULL });
    assert_int_equal(labial_voice_counts(&voice).skipped, 6);
    assert_int_equal(labial_voice_counts(&voice).told, 12);
    assert_int_equal(labial_voice_end(&voice, 0), 1200);
}

TEST_AFTER(begin, visemes_of_polly)
{
    message.kind = LABIAL_VOICE_POLLY;
    tell_texts(0, 100, (const char *const[]){ "sil", "u", "@", "sil", NULL });
    tell_texts(300, 0, (const char *const[]){ "q", "si", "xil", "sal", "six", "", NULL });
    assert_known("100-200 W, 200-300 AH");
    assert_int_equal(labial_voice_counts(&voice).skipped, 6);
    assert_int_equal(labial_voice_end(&voice, 0), 400);
}

TEST_AFTER(begin, the_first_kind_counts)
{
    message.kind = LABIAL_VOICE_CHARACTERS;
    characters("no", 0);
    assert_ok(tell());
    message.kind = LABIAL_VOICE_WORDS;
    tell_one("hum", 0, 300);
    assert_non_null(strstr(known(), "-300 M"));
    assert_null(strstr(said, "OW"));
    message.kind = LABIAL_VOICE_PHONEMES;
    tell_one("S", 100, 200);
    assert_known("100-200 S");
    message.kind = LABIAL_VOICE_WORDS;
    tell_one("no", 300, 400);
    assert_known("100-200 S");
}

/* ---- Words and characters ---------------------------------------------------------------------------------------- */

TEST_AFTER(begin, words_are_those_of_the_library)
{
    static const char *const texts[] = { "Maybe,", "people", "(", "hum", "\xe4\xbd\xa0\xe5\xa5\xbd", "strengths" };
    static const int starts[] = { 100, 560, 700, 970, 1400, 1800 }, ends[] = { 520, 950, -1, 1200, 1700, -1 };
    labial_words_t words;
    unsigned phoneme;
    uint32_t milliseconds, time = 0;
    char wanted[2000];
    size_t size = 0;
    message.kind = LABIAL_VOICE_WORDS;
    labial_words_init(&words, &words_en, NULL, 0);
    for (unsigned i = 0; i <= 6; i++) {
        if (i < 6) {
            tell_one(texts[i], starts[i], ends[i]);
            assert_ok(labial_words_push(&words, texts[i], strlen(texts[i]), (uint32_t)starts[i], (uint32_t)ends[i]));
        } else {
            labial_words_end(&words);
        }
        while (labial_words_next(&words, &phoneme, &milliseconds) == LABIAL_OK) {
            if (phoneme != 0)
                size += (size_t)snprintf(wanted + size, sizeof wanted - size, "%s%u-%u %s", size > 0 ? ", " : "",
                                         (unsigned)time, (unsigned)(time + milliseconds),
                                         labial_words_label(&words_en, phoneme));
            time += milliseconds;
        }
    }
    assert_known(wanted);
    assert_int_equal(labial_voice_end(&voice, 0), time);
    tell_one("\xe4\xbd\xa0", 3000, -1);
    assert_int_equal(labial_voice_end(&voice, 0), 3300); /* two phonemes that nobody knows */
    tell_one("...", 3300, -1);
    assert_int_equal(labial_voice_end(&voice, 0), 3300);
    tell_one("hum", 3320, 3320); /* its end is not known, either */
    assert_in_range(labial_voice_end(&voice, 0), 3400, 3700);
    tell_one("hum", 3400, 5000);
    assert_int_equal(labial_voice_end(&voice, 0), 5000);
}

TEST_AFTER(begin, characters_are_words_between_blanks)
{
    char first[1000];
    message.kind = LABIAL_VOICE_CHARACTERS;
    characters("hum [softly] by", 0);
    assert_ok(tell());
    strcpy(first, known());
    begin_of(LABIAL_VOICE_CHARACTERS);
    item("hum ", 0, 200); /* the same in pieces, with a tag of another kind */
    item("<a b", 200, 400);
    item(">\xc2\xa0", 400, 600);
    item("\xe2\x80\x83", 600, 600);
    item("\xe3\x80\x80", 600, 600);
    tell_one("by", 650, 750);
    assert_known(first);
    plan_from = 640;
    assert_known(strstr(first, "650"));
    plan_from = 0;
    tell_one("\xe2\x80\x93", 740, 760); /* no blank */
    tell_one("\n", 760, 770);
    tell_one("\xc3\xa9", 770, 775);
    tell_one("\x0e", 775, 777);                     /* no blank */
    tell_one("\xf0\x80\x80\x80\x80\xff", 777, 780); /* no UTF-8 */
    tell_one(" ", 780, 790);
    tell_one("[", 800, 700); /* ends before it begins: with its beginning, and no tag, as it is not closed */
    tell_one("hum", 800, 950);
    tell_one("<", 950, -1);
    assert_non_null(strstr(known(), "-950 M"));
    assert_int_equal(labial_voice_counts(&voice).skipped, 0);
}

TEST_AFTER(begin, old_characters_are_forgotten_up_to_a_blank)
{
    message.kind = LABIAL_VOICE_CHARACTERS;
    for (unsigned i = 0; i < 20; i++) {
        characters("no hum by ", 1000 * (int)i);
        tell_one("\xc3\xa9", 1000 * (int)i + 500, 1000 * (int)i + 550);
        play(1000 * (uint64_t)i);
    }
    assert_in_range(voice.utterances[0].places, 20, 60);
    for (unsigned i = 20; i < 40; i++) {
        characters("no hum by ", 1000 * (int)i);
        tell_one("\xc3\xa9", 1000 * (int)i + 500, 1000 * (int)i + 550);
    }
    for (plan_from = 35000; plan_from < 36000; plan_from += 50) { /* more than a hundred characters are known before */
        assert_non_null(strstr(known(), "36500-"));
        assert_true(atol(said) >= plan_from);
    }
    plan_from = 0;
}

TEST_AFTER(begin, characters_that_overlap_and_long_words)
{
    char text[301];
    message.kind = LABIAL_VOICE_CHARACTERS;
    item("hum by", 0, 600);
    tell_one(" no", 250, 300); /* begins within the word before it */
    assert_non_null(strstr(known(), "-400 M"));
    begin_of(LABIAL_VOICE_CHARACTERS);
    memset(text, 'o', 300);
    text[300] = '\0';
    characters(text, 0);
    assert_ok(tell());
    known();
    assert_non_null(strstr(said, "-15000 "));
}

TEST_AFTER(begin, a_blank_that_ends_a_message_still_ends_its_word)
{
    static const struct {
        int start, end; /* of the blank */
        int next;       /* the beginning of the next message */
        int is_kept;
    } cases[] = { { 300, 300, 300, 1 }, { 301, 301, 300, 1 }, { 299, 301, 300, 1 }, { 301, 320, 300, 1 },
                  { 300, -1, 300, 1 },  { 300, 330, 300, 0 }, { 300, 330, 330, 1 } };
    char apart[500];
    for (unsigned i = 0; i < COUNT_OF(cases); i++) {
        begin_of(LABIAL_VOICE_CHARACTERS);
        for (unsigned k = 0; k < 2; k++) {
            item("Bob", 0, 300);
            tell_one(" ", cases[i].start, cases[i].end);
        }
        for (unsigned k = 0; k < 3; k++) { /* nothing grows */
            item("may", cases[i].next, cases[i].next + 300);
            assert_ok(tell());
            assert_in_range(voice.utterances[0].places, 2, 3);
        }
        strcpy(apart, known());
        begin_of(LABIAL_VOICE_CHARACTERS);
        item("Bob", 0, 300);
        if (cases[i].is_kept)
            item(" ", 300, 300);
        item("may", cases[i].next, cases[i].next + 300);
        assert_ok(tell());
        assert_known(apart);
    }
}

static char noted[2000];

static const labial_words_own_t *note(void *user, const char *text, size_t size)
{
    char *const words = (char *)user;
    memcpy(words + strlen(words), text, size); /* behind it are zeros */
    words[strlen(words)] = '|';
    return NULL;
}

/* The words that the characters of a text are. */
static const char *words_in(const char *text)
{
    begin_with(PLACES);
    memset(noted, 0, sizeof noted);
    message.kind = LABIAL_VOICE_CHARACTERS;
    characters(text, 0);
    assert_ok(labial_voice_pronounce(&voice, note, noted));
    assert_ok(tell());
    known();
    return noted;
}

TEST(words_of_scripts_without_blanks)
{
    static const char *const cases[][2] = {
        { "妈妈爸爸，朋友们……好——吗？「是」。", "妈妈爸爸|朋友们|好|吗|是|" },
        { "你好,世界.再见!好吗?是:的;A,B.豈!", "你好|世界|再见|好吗|是|的|A,B.豈|" },
        { ",你 .好𠀀!⼀.⺀?々,㐀;", ",你|.好𠀀|⼀|⺀|々|㐀|" },
        { "今日は新聞を読みました。", "今日は|新聞を|読みまし|た|" },
        { "Tシャツとバスに乗り、コンピューターをつかって、しゃっきんばなしだ",
          "Tシャツ|と|バスに|乗り|コンピュー|ターをつ|かって|しゃっきん|ばなしだ|" },
        { "はA あいうえB", "はA|あいうえB|" },
        { "ぱはぱんをたべます", "ぱはぱん|をたべます|" },
        { "すごーいね・ァかヽかか゛か", "すごーい|ね|ァかヽか|か゛か|" },
        { "แม่และพ่อไปซื้อปลา, ດີເດັກ!ก", "แม่|และพ่อ|ไปซื้อปลา|ດີ|ເດັກ|ก|" },
        { "वह घर,गया 엄마와!아빠", "वह|घर,गया|엄마와!아빠|" },
        { "[妈妈]爸,[b", "爸|[b|" },
        { "a [b c](d) [1](e) [2][3] [f][4] [g][h] [i][!] [j][] [é](k) [[l] m](n) [o",
          "a|b|c](d)|[1](e)|[2]|f]|j]|é](k)|m](n)|[o|" },
    };
    char text[301];
    for (unsigned i = 0; i < COUNT_OF(cases); i++)
        assert_string_equal(words_in(cases[i][0]), cases[i][1]);
    memset(text, 'o', 300);
    text[300] = '\0';
    words_in(text);
    assert_int_equal(strlen(noted), 305);
    assert_int_equal(strcspn(noted, "|"), LABIAL_VOICE_LETTERS);
}

TEST_AFTER(begin, long_texts_without_blanks_are_forgotten)
{
    message.kind = LABIAL_VOICE_CHARACTERS;
    for (unsigned i = 0; i < 40; i++) {
        characters("妈妈爸爸跑步，朋友。", 500 * (int)i);
        assert_ok(tell());
        play(500 * (uint64_t)i);
    }
    assert_in_range(voice.utterances[0].places, 50, 150);
    plan_from = 19000;
    assert_true(atol(known()) >= plan_from);
}

TEST_AFTER(begin, a_tag_is_looked_for_in_a_hundred_characters)
{
    message.kind = LABIAL_VOICE_CHARACTERS;
    item("[", 0, 10);
    item(" oh", 10, 200);
    for (int i = 2; i <= 101; i++)
        item(" ", 10 * i + 180, 10 * i + 190);
    item("]", 1200, 1210);
    tell_one("no", 1240, 1400);
    assert_true(strncmp(known(), "73-", 3) == 0); /* it has no end that is near enough */
    tell_one("]", 1170, 1195);
    assert_true(strncmp(known(), "1200-", 5) == 0);
}

static const uint8_t own_sounds[] = { SPEECH_EN_S, SPEECH_EN_T };
static const labial_words_entry_t own_entry = { "hum", own_sounds, 2 };
static const labial_words_own_t own_words = { &own_entry, 1 };
static unsigned asked;

static const labial_words_own_t *ask(void *user, const char *text, size_t size)
{
    assert_ptr_equal(user, &asked);
    asked++;
    return size == 3 && memcmp(text, "hum", 3) == 0 ? &own_words : NULL;
}

TEST_AFTER(begin, pronunciations_are_the_callers)
{
    message.kind = LABIAL_VOICE_WORDS;
    tell_one("hum", 0, 200);
    assert_ok(labial_voice_words(&voice, &words_en, &own_words));
    assert_non_null(strstr(known(), "S, "));
    assert_ok(labial_voice_words(&voice, &words_en, NULL));
    assert_non_null(strstr(known(), "HH, "));
    assert_ok(labial_voice_pronounce(&voice, ask, &asked));
    tell_one("no", 200, -1);
    assert_non_null(strstr(known(), "S, "));
    assert_true(asked >= 2);
    begin_with(PLACES);
    assert_ok(labial_voice_pronounce(&voice, ask, &asked));
    message.kind = LABIAL_VOICE_CHARACTERS;
    characters("hum", 0);
    assert_ok(tell());
    assert_non_null(strstr(known(), "S, "));
}

/* How often words are read that are told one by one, each before a frame, far ahead of the sound. */
static unsigned reads(unsigned words)
{
    int16_t faps[LABIAL_CHANNELS];
    begin_with(PLACES);
    assert_ok(labial_voice_pronounce(&voice, ask, &asked));
    asked = 0;
    for (unsigned i = 0; i < words; i++) {
        assert_ok(labial_voice_word(&voice, "people", 6, 400 * i, 400 * i + 350));
        assert_ok(labial_voice_next(&voice, 20 * i, NULL, faps));
    }
    return asked;
}

TEST_AFTER(begin, work_is_linear_in_what_is_told)
{
    const unsigned few = reads(PLACES / 8);
    assert_in_range(few, 3, PLACES / 8); /* of most the sound is not near yet */
    assert_true(reads(PLACES / 4) <= 2 * few + 8);
}

TEST_AFTER(begin, utterances_queue_behind_each_other)
{
    assert_int_equal(name("a"), 0xe40c292c); /* FNV-1a */
    assert_int_equal(labial_voice_identity(NULL, 7), labial_voice_identity("", 0));
    assert_int_equal(labial_voice_identity("\xcc\x24\x31\xc4", 4), 1); /* whose hash is 0 */
    assert_follows(
        "a: 0-500 M; b: 0-100 S; c: 0-100 F; a: 500-700 AA", /* more of the first one: the others come later */
        "0-500 M, 500-700 AA, 700-800 S, 800-900 F");
    assert_follows("b: 50-70 S; 100-150 F", /* of the latest one */
                   "0-500 M, 500-700 AA, 700-750 S, 750-770 S, 800-900 F, 900-950 F");
    assert_follows("b: 100-300 S", "0-500 M, 500-700 AA, 700-750 S, 750-770 S, 800-1000 S, 1000-1100 F, 1100-1150 F");
}

TEST_AFTER(begin, what_is_heard_is_not_moved)
{
    assert_follows("a: 0-500 M; b: 0-900 S; play 600; a: 500-1700 AA", /* late: it is cut where the next one began */
                   "0-500 M, 500-1400 S");
    assert_follows("begin 2000 c; b: 900-2700 AA", /* nor what the caller tells */
                   "0-500 M, 500-1400 S, 1400-2000 AA");
}

/* A client that feeds a message before it begins to play its sound: the message is of that sound. */
TEST_AFTER(begin, an_utterance_that_is_told_before_it_begins)
{
    assert_follows("0-500 M; begin 0", "0-500 M");                      /* or nothing of it would be heard */
    assert_follows("begin 1000; 0-500 S; finish; play 2000; 100-400 M", /* that was the first one's sound */
                   "0-500 M, 1000-1500 S, 2120-2420 M");
    assert_follows("play 2200; begin 2300; 400-800 AA", "0-500 M, 1000-1500 S, 2400-2700 M, 2700-3100 AA");
    follow("finish; 100-400 S; play 4000"); /* behind it, and heard: what begins now is another one */
    assert_follows("begin 4500; 0-500 M", "1000-1500 S, 2400-2700 M, 2700-3100 AA, 3200-3500 S, 4500-5000 M");
    plan_from = 4000;
    assert_follows("begin; 100-200 S", "4500-5000 M, 5100-5200 S");
    assert_follows("a: 200-300 F; begin 6000; 0-500 M", /* what has a name is moved by it alone */
                   "4500-5000 M, 5100-5200 S, 5200-5300 F, 6000-6500 M");
    assert_follows("begin; begin 7000; 0-500 S", /* nothing was told that could be moved */
                   "4500-5000 M, 5100-5200 S, 5200-5300 F, 6000-6500 M, 7000-7500 S");
}

/* A service that names its answers, and a client that does not know the names: each sound is that of the first answer
 * that waits. */
TEST_AFTER(begin, named_utterances_that_are_told_before_they_begin)
{
    assert_follows("a: 0-500 M; b: 0-500 S; c: 0-500 F", "0-500 M, 500-1000 S, 1000-1500 F");
    assert_follows("begin 0", "0-500 M, 500-1000 S, 1000-1500 F");
    assert_follows("play 800; begin 900", "0-500 M, 900-1400 S, 1400-1900 F"); /* the second one's sound is late */
    assert_follows("b: 500-700 AA", "0-500 M, 900-1400 S, 1400-1600 AA, 1600-2100 F");
    assert_follows("play 2000; begin 2200", "0-500 M, 900-1400 S, 1400-1600 AA, 2200-2700 F");
    assert_follows("begin 2900; d: 0-500 S; e: 0-500 M", /* nothing waits */
                   "0-500 M, 900-1400 S, 1400-1600 AA, 2200-2700 F, 2900-3400 S, 3400-3900 M");
    assert_follows("play 6000; begin 6000; f: 0-500 S", "2900-3400 S, 3400-3900 M, 6000-6500 S"); /* it is over */
}

/* Both seem to be heard by now, but the sound of the first one begins later. */
TEST_AFTER(begin, what_waits_behind_an_utterance_that_is_late_waits_longer)
{
    assert_follows("a: 0-100 M; b: 0-530 S; c: 0-500 F; play 620; begin 640 b", "0-100 M, 640-1170 S, 1170-1670 F");
}

TEST_AFTER(begin, what_begins_at_once_after_a_cancel_may_be_told_its_sound)
{
    assert_follows("0-500 M; play 100; cancel 100; begin; b: 0-500 S; begin 400; b: 500-600 AA",
                   "400-900 S, 900-1000 AA");
}

TEST_AFTER(begin, stale_messages_change_nothing)
{
    follow("a: 0-500 M; play 100; cancel 100; dropped a: 500-900 M");
    follow(
        "dropped b: 0-900 M; dropped 0-900 M"); /* of the cancelled answer as well, as it comes before the next begins */
    assert_follows("begin 1000; c: 0-100 S; dropped b: 0-900 AA; dropped a: 0-900 AA", "1000-1100 S");
    assert_int_equal(labial_voice_counts(&voice).dropped, 5);
    assert_follows("begin a; a: 0-100 AA", "1000-1100 S, 1100-1200 AA"); /* unless the caller says so */
}

TEST_AFTER(begin, utterances_that_were_not_told_of_yet)
{
    assert_follows("a: 0-500 M; begin 1000 b; begin 2000; begin c; c: 600-700 S; b: 600-700 S; a: 600-700 S",
                   "0-500 M, 600-700 S, 1600-1700 S, 2600-2700 S");
    assert_follows("b: 700-5000 F", /* nobody is queued behind it: the next one begins at 2000 */
                   "0-500 M, 600-700 S, 1600-1700 S, 1700-2000 F, 2600-2700 S");
    follow("cancel 100");
    assert_int_equal(voice.used, 0);
    assert_follows("begin 0; 0-100 M", "0-100 M");
    follow("begin 20000; 0-500 S; play 15000; 500-600 S"); /* until then the one before is kept */
    assert_int_equal(voice.utterance_count, 2);
}

TEST_AFTER(begin, an_utterance_that_ended_is_over)
{
    follow("a: 0-500 M; b: 0-500 S");
    for (unsigned i = 1; i < 200; i++)
        play(100 * i);
    follow("b: 19500-19900 S; dropped a: 500-900 M");
    assert_int_equal(voice.utterance_count, 1);
}

TEST_AFTER(begin, after_the_end_the_next_one_begins)
{
    assert_follows("a: 0-500 M; finish; a: 500-600 AA; 0-100 S", /* the one that ended goes on */
                   "0-500 M, 500-600 AA, 600-700 S");
    assert_follows("finish; b: 0-100 F", "0-500 M, 500-600 AA, 600-700 S, 700-800 F");
    assert_int_equal(voice.utterance_count, 3);
    follow("finish; play 5000; done; begin 900; not done"); /* and one that began has not ended */
}

TEST_AFTER(begin, an_utterance_ends_where_the_next_begins)
{
    assert_follows("0-500 M; begin 300; begin 400; 0-100 S", /* the one before has nothing, but it began */
                   "0-300 M, 400-500 S");
    assert_int_equal(voice.utterance_count, 2);
    assert_follows("begin 100; 0-50 F", "0-100 M, 100-150 F");
    assert_follows("begin 50; begin 20", "0-20 M"); /* in its place */
}

TEST_AFTER(begin, an_utterance_that_was_told_begins_with_its_sound)
{
    assert_follows("a: 0-500 M; b: 0-100 S; c: 0-100 F; finish; begin 200 a", "200-700 M, 700-800 S, 800-900 F");
    assert_follows("begin b; begin 600 b", "200-600 M, 600-700 S, 800-900 F"); /* the first changes nothing */
    assert_follows("b: 100-400 S", "200-600 M, 600-700 S, 700-1000 S, 1000-1100 F");
    assert_int_equal(voice.utterance_count, 3);
    follow("play 1500; not done; play 1600; done; begin 3000 b"); /* once more, under the same name */
    assert_int_equal(voice.utterance_count, 4);
}

TEST_AFTER(begin, what_waits_gives_way_to_what_begins)
{
    assert_follows("a: 0-3000 AA; b: 0-1000 IY; begin 1000 c; c: 0-500 S; a: 3000-4000 AA", "0-1000 AA, 1000-1500 S");
    assert_follows("begin 1200; 0-100 M", "0-1000 AA, 1000-1200 S, 1200-1300 M"); /* before what is known ends */
    assert_follows("begin 1100; 0-20 M", "0-1000 AA, 1000-1100 S, 1100-1120 M");
    follow("finish; play 1580; not done; play 1600; done");
}

TEST_AFTER(begin, an_offset_moves_the_ends_too)
{
    assert_ok(labial_voice_offset(&voice, 300));
    assert_follows("0-500 M; begin 500; 0-500 S", "300-800 M, 800-1300 S");
    follow("finish; play 1700; not done; play 1800; done");
}

TEST_AFTER(begin, what_is_refused_or_empty_changes_nothing)
{
    static char text[256];
    memset(text, 'a', sizeof text - 1);
    follow("0-500 M; finish; not done; b: ; b: 100-50 M"); /* a last message without items */
    assert_int_equal(labial_voice_counts(&voice).skipped, 1);
    message.kind = LABIAL_VOICE_WORDS;
    for (unsigned i = 0; i < PLACES; i++)
        item(text, 10 * (int64_t)i, 10 * (int64_t)i + 10);
    assert_int_equal(tell(), LABIAL_ERROR_FULL);
    assert_int_equal(voice.utterance_count, 1);
    follow("play 1000; done");
}

TEST_AFTER(begin, there_are_only_so_many_utterances)
{
    char step[] = "a: 0-100 M";
    for (; step[0] < 'a' + LABIAL_VOICE_UTTERANCES; step[0]++)
        follow(step);
    follow("full 0: 0-100 M");
    assert_int_equal(labial_voice_begin(&voice, 5, name("0")), LABIAL_ERROR_FULL);
    assert_int_equal(labial_voice_begin(&voice, LABIAL_VOICE_BEHIND, 0), LABIAL_ERROR_FULL);
    follow("finish; full 0-100 M; play 4000; play 9000; 0-100 M"); /* the first ones are over */
}

/* ---- Times of messages ------------------------------------------------------------------------------------------- */

TEST_AFTER(begin, chained_messages_begin_where_the_last_one_ended)
{
    message.times = LABIAL_VOICE_CHAINED;
    for (unsigned i = 0; i < 4; i++) { /* rounding does not add up */
        item("M", 0, 0);
        items[0].end = 100400;
        assert_ok(tell());
    }
    assert_known("0-100 M, 100-201 M, 201-301 M, 301-402 M");
}

TEST_AFTER(begin, joined_messages_that_begin_again)
{
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_M, 100, 400));
    message.times = LABIAL_VOICE_JOINED;
    follow(
        "a: 100-200 M, 200-400 AA; a: 400-500 M, 500-700 AA"); /* the program's own phonemes do not count; goes on, */
    follow("a: 0-150 S, 150-300 F; a: 300-400 S");             /* begins again, and goes on from there */
    assert_follows("a: 0-100 F; a: 0-100 F",                   /* comes twice */
                   "100-200 M, 200-400 AA, 400-500 M, 500-700 AA, 700-850 S, 850-1000 F, 1000-1100 S, "
                   "1100-1200 F");
    assert_int_equal(labial_voice_counts(&voice).dropped, 1);
    follow("a: 5-24 S; a: 0-0 S; a: 0- S"); /* less than rounding, and nothing at all */
    assert_int_equal(voice.utterances[0].base, 1100 * MS);
}

TEST_AFTER(begin, joined_messages_fill_gaps)
{
    message.times = LABIAL_VOICE_JOINED;
    assert_follows("0-200 M; 400-600 S, 600-700 T; 195-405 AA", /* late, and rounded */
                   "0-195 M, 195-400 AA, 400-600 S, 600-700 T");
}

TEST_AFTER(begin, joined_messages_begin_again_after_what_is_forgotten)
{
    message.times = LABIAL_VOICE_JOINED;
    for (unsigned i = 0; i < 40; i++) {
        tell_one("M", 300 * (int)i, 300 * (int)i + 250);
        play(300 * (uint64_t)i + 200);
    }
    assert_true(voice.utterances[0].over > 5000 && voice.utterances[0].places < 20);
    tell_one("S", 0, 200);
    assert_int_equal(voice.utterances[0].base, (39 * 300 + 250) * MS);
    tell_one("S", 200, 300);
    plan_from = 11000;
    assert_non_null(strstr(known(), "11700-11950 M, 11950-12150 S, 12150-12250 S"));
    plan_from = 0;
}

/* Messages of 1,010 ms at these seconds play until `until` ms, then one at 2 s comes: whether it begins again. */
static int late_message_begins_again(const uint8_t *seconds, unsigned count, uint64_t until)
{
    message.times = LABIAL_VOICE_JOINED;
    for (unsigned i = 0; i < count; i++)
        tell_one("M", 1000 * seconds[i], 1000 * seconds[i] + 1010);
    play(until);
    tell_one("S", 2000, 2900);
    return voice.utterances[0].base > 0u;
}

TEST_AFTER(begin, what_comes_after_its_time_was_not_told)
{
    static const uint8_t later[] = { 3, 5, 10 }, around[] = { 0, 1, 3, 4, 10 }, far[] = { 100, 110 };
    assert_int_equal(late_message_begins_again(later, 3, 9000), 0);
    assert_true(voice.utterances[0].over == 4010 && voice.utterances[0].paused == 3000);
    tell_one("T", 2000, 2800); /* now it was told, and is forgotten, too */
    assert_true(voice.utterances[0].over == 4010 && voice.utterances[0].paused == 0);
    assert_int_equal(voice.utterances[0].base, 11010 * MS);
    assert_ok(labial_voice_begin(&voice, 20000, 0));
    play(20000);
    assert_int_equal(late_message_begins_again(around, 5, 29000), 0);
    assert_true(voice.utterances[0].pause == 2010 && voice.utterances[0].paused == 990);
    assert_ok(labial_voice_begin(&voice, 40000, 0));
    play(40000);
    assert_int_equal(late_message_begins_again(far, 2, 155000), 0);
    assert_int_equal(voice.utterances[0].paused, 65535);
}

TEST_AFTER(begin, a_key_replaces_what_was_told_of_it)
{
    message.kind = LABIAL_VOICE_WORDS;
    message.key = 1;
    tell_one("hum", 0, 200);
    message.key = 2;
    item("no", 200, 300);
    tell_one("no", 300, 500);
    message.key = 70000; /* another one, though it is kept in 16 bits */
    tell_one("by", 500, 700);
    message.key = 2;
    tell_one("by", 250, 400);
    assert_int_equal(voice.utterances[0].places, 3);
    message.key = 1;
    assert_ok(tell());
    assert_int_equal(voice.utterances[0].places, 2);
    assert_int_equal(voice.items[labial_voice_find(&voice, voice.utterances, 0)].start, 250);
}

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

TEST_AFTER(begin, memory_is_bounded)
{
    begin_with(12);
    message.kind = LABIAL_VOICE_WORDS;
    for (int i = 0; i < 6; i++)
        tell_one("people", 300 * i, 300 * i + 200); /* two places each */
    item("a", 1800, 1900);
    assert_int_equal(tell(), LABIAL_ERROR_FULL);
    tell_one("pupils", 1500, 1700); /* in place of one that was there */
    play(6000);
    for (int i = 0; i < 200; i++) {
        tell_one(i % 3 ? "a" : "people", 4500 + 600 * i, 4800 + 600 * i);
        play((uint64_t)(6000 + 600 * i));
    }
    assert_true(voice.used <= 12);
    assert_true(labial_voice_counts(&voice).told == 207 && labial_voice_counts(&voice).skipped == 0);
    assert_int_equal(labial_voice_init(&voice, &speech_en, memory, LABIAL_VOICE_SIZE(3, 8, 1) - 1),
                     LABIAL_ERROR_WORKSPACE);
}

TEST_AFTER(begin, texts_are_kept_up_to_255_bytes)
{
    char text[301];
    message.kind = LABIAL_VOICE_WORDS;
    memset(text, 'a', 300);
    text[300] = '\0';
    memcpy(text + 253, "\xe4\xbd\xa0", 3);
    tell_one(text, 0, 500);
    assert_int_equal(voice.items[0].size, 253);
    assert_int_equal(voice.utterances[0].places, labial_voice_places(253));
    memset(text, 0x80, 300); /* no character begins anywhere */
    tell_one(text, 500, 600);
    assert_int_equal(voice.items[labial_voice_places(253)].size, 0);
    assert_ok(labial_voice_word(&voice, text, 100000, 700, 800));
    message.kind = LABIAL_VOICE_CHARACTERS;
}

TEST_AFTER(begin, items_that_make_no_sense_are_skipped)
{
    static const int64_t times[][2] = { { 200, 100 }, { 0, 3600001 }, { 86400001, 86400001 }, { 86399999, 86400001 } };
    for (unsigned i = 0; i < 4; i++)
        item("M", times[i][0], times[i][1]);
    item("M", 100, 200);
    item("M", 0, 0);
    items[5].phoneme = 40;
    assert_ok(tell());
    assert_known("100-200 M");
    assert_int_equal(labial_voice_counts(&voice).skipped, 5);
    assert_ok(labial_voice_phoneme(&voice, 1000, 0, 5));
    message.kind = LABIAL_VOICE_AZURE;
    assert_ok(labial_voice_begin(&voice, 300, 0));
    item("1", 0, 5);
    items[0].text = NULL;
    assert_ok(tell());
    assert_int_equal(labial_voice_counts(&voice).skipped, 7);
    message.times = LABIAL_VOICE_CHAINED; /* beyond a day once it is chained */
    message.kind = LABIAL_VOICE_PHONEMES;
    tell_one("M", 86000000, 86400000);
    tell_one("M", 0, 1);
    assert_int_equal(labial_voice_counts(&voice).skipped, 8);
}

/* ---- Frames ------------------------------------------------------------------------------------------------------ */

enum { FRAMES = 130 };

static const int16_t rest[LABIAL_CHANNELS];
static int16_t wanted[FRAMES][LABIAL_CHANNELS], shown[FRAMES][LABIAL_CHANNELS];
static unsigned frame_count;

static void on_wanted(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    if (frame < FRAMES)
        memcpy(wanted[frame], faps, sizeof wanted[frame]);
}

static const struct {
    unsigned phoneme, milliseconds;
} sentence[] = { { SPEECH_EN_SIL, 100 }, { SPEECH_EN_M, 70 },    { SPEECH_EN_EY, 130 },     { SPEECH_EN_B, 60 },
                 { SPEECH_EN_IY, 140 },  { SPEECH_EN_SIL, 250 }, { SPEECH_EN_G, 70 },       { SPEECH_EN_OW, 180 },
                 { SPEECH_EN_P, 80 },    { SPEECH_EN_UW, 220 },  { SPEECH_EN_SIL, 3600000 } };
enum {
    SENTENCE = COUNT_OF(sentence),
    MOVES = 76, /* frames, until the face begins to ease to rest, 200 ms behind the last phoneme, */
    RESTS = 90  /* and until it is there */
};

/* The frames of the sentence, `later` milliseconds later, from a stream that has all of it. */
static void want(unsigned later)
{
    static labial_t stream;
    static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];
    labial_init(&stream, &speech_en, workspace, sizeof workspace, on_wanted, NULL);
    for (unsigned i = 0; i < SENTENCE; i++)
        assert_ok(labial_push(&stream, sentence[i].phoneme, sentence[i].milliseconds + (i == 0 ? later : 0)));
    while (labial_latency(&stream).frames > 180000 - FRAMES)
        labial_tick(&stream);
}

/* Eases these frames to rest after the sentence. */
static void want_rest(void)
{
    for (unsigned i = MOVES; i < FRAMES; i++) {
        const int32_t left = i < RESTS ? 16384 - labial_ease(20 * i - 1500, 300) : 0;
        for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
            wanted[i][k] = (int16_t)((wanted[i][k] * left + 8192) >> 14);
    }
}

static void tell_sentence(unsigned from, unsigned to)
{
    uint32_t time = 0;
    for (unsigned i = 0; i < to && i < SENTENCE - 1u; time += sentence[i++].milliseconds)
        if (i >= from && sentence[i].phoneme != SPEECH_EN_SIL)
            assert_ok(labial_voice_phoneme(&voice, sentence[i].phoneme, time, time + sentence[i].milliseconds));
}

static void show_until(unsigned milliseconds)
{
    uint32_t frame = 77;
    for (unsigned now = 20 * frame_count; now <= milliseconds; now += 20) {
        assert_ok(labial_voice_next(&voice, now, &frame, shown[frame_count]));
        assert_int_equal(labial_voice_next(&voice, now, &frame, shown[frame_count]), LABIAL_WAITING);
        assert_int_equal(frame, frame_count);
        frame_count++;
    }
}

SETUP(begin_frames)
{
    begin_with(PLACES);
    frame_count = 0;
    want(0);
    want_rest();
    return 0;
}

TEST_AFTER(begin_frames, what_is_told_in_time_is_exact)
{
    tell_sentence(0, 5);
    for (unsigned t = 0; t < 2400; t += 13) {
        if (t >= 200 && t < 213)
            tell_sentence(5, 9);
        if (t >= 494 && t < 507)
            tell_sentence(9, SENTENCE);
        show_until(t);
    }
    assert_int_equal(frame_count, 120);
    assert_memory_equal(shown, wanted, 120 * sizeof *shown);
}

TEST_AFTER(begin_frames, the_face_rests_after_all_that_is_known)
{
    int before = 0;
    want(0);
    tell_sentence(0, SENTENCE);
    show_until(2000);
    for (unsigned i = MOVES; i < RESTS; i++) {
        const double way = (20.0 * i - 1500) / 300, left = 1 - way * way * (3 - 2 * way);
        for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
            assert_in_range(10 + shown[i][k] - (int)(left * wanted[i][k]), 9, 11); /* both may be rounded */
    }
    for (unsigned i = RESTS; i < frame_count; i++)
        assert_memory_equal(shown[i], rest, sizeof rest);
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        before += abs(wanted[RESTS][k]);
    assert_true(before > 8); /* where the silence of the model stays */
    assert_ok(labial_voice_begin(&voice, 2100, 0));
    tell_sentence(0, SENTENCE);
    want(2100);
    show_until(2580);
    for (unsigned i = 113; i < FRAMES; i++) /* a stream from another second on searches a little otherwise */
        for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
            assert_in_range(8 + shown[i][k] - wanted[i][k], 0, 16);
}

TEST_AFTER(begin_frames, what_is_told_late_fades_in)
{
    tell_sentence(0, 6);
    show_until(700);
    tell_sentence(6, SENTENCE);
    tell_sentence(6, SENTENCE);   /* again: nothing new */
    labial_voice_t moved = voice; /* the structure may be moved */
    memset(&voice, 0xa5, sizeof voice);
    voice = moved;
    show_until(2300);
    assert_memory_equal(shown, wanted, 20 * sizeof *shown); /* those that do not see the end of the pause */
    assert_memory_not_equal(shown[36], wanted[36], sizeof *shown);
    assert_memory_equal(shown[43], wanted[43], (116 - 43) * sizeof *shown);
    tell_sentence(0, 2); /* long over */
    show_until(2400);
    assert_memory_equal(shown[116], wanted[116], 5 * sizeof *shown);
}

/* How far apart the lips are in a frame that was shown. */
static int opening(unsigned frame)
{
    return -(shown[frame][3] + shown[frame][4]);
}

TEST_AFTER(begin_frames, lips_meet_for_a_contact_that_is_told_when_it_begins)
{
    int before, least = 1000;
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_AA, 100, 600));
    show_until(580);
    before = opening(29);
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_B, 600, 660));
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_AA, 660, 900));
    show_until(900);
    for (unsigned i = 30; i < 34; i++)
        least = opening(i) < least ? opening(i) : least;
    assert_in_range(before, 150, 450);
    assert_in_range(20 + least, 0, 50);
    assert_true(opening(30) > 80); /* not at once */
    assert_true(opening(40) > 150);
}

TEST_AFTER(begin_frames, a_change_and_its_opposite_are_none)
{
    tell_sentence(0, SENTENCE);
    show_until(300);
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_F, 300, 360));
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_B, 300, 360));
    show_until(2300);
    assert_memory_equal(shown, wanted, 116 * sizeof *shown);
}

TEST_AFTER(begin_frames, another_phoneme_of_the_same_time)
{
    tell_sentence(0, SENTENCE);
    show_until(300);
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_AA, 170, 300));
    show_until(400);
    assert_memory_not_equal(shown[19], wanted[19], sizeof *shown);
}

TEST_AFTER(begin_frames, an_utterance_in_two_months)
{
    want(0); /* the face does not come to rest before it */
    tell_sentence(0, SENTENCE);
    assert_ok(labial_voice_begin(&voice, UINT64_C(5000000000), 0));
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_AA, 0, 100));
    show_until(2000);
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_AA, 100, 200));
    show_until(2200);
    assert_memory_equal(shown, wanted, 111 * sizeof *shown);
}

TEST_AFTER(begin_frames, phonemes_that_the_model_does_not_have)
{
    uint8_t shares[LABIAL_VISEMES] = { 0 };
    int16_t faps[LABIAL_CHANNELS];
    assert_ok(labial_voice_init(&voice, &laughter_synthetic, memory, sizeof memory));
    assert_ok(labial_voice_words(&voice, &words_en, NULL));
    assert_ok(labial_voice_word(&voice, "zoo", 3, 0, 500)); /* no numbers were given */
    for (unsigned k = 0; k < 40; k++)
        assert_ok(labial_voice_next(&voice, 20 * k, NULL, faps));
    assert_ok(labial_voice_visemes(&voice, shares));
    assert_int_equal(shares[LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
}

TEST_AFTER(begin_frames, clocks_jump)
{
    int16_t faps[LABIAL_CHANNELS];
    uint32_t frame;
    tell_sentence(0, SENTENCE);
    show_until(200);
    assert_int_equal(labial_voice_next(&voice, 100, &frame, faps), LABIAL_WAITING);
    assert_ok(labial_voice_next(&voice, 1240, &frame, faps));
    assert_int_equal(frame, 62);
    assert_int_equal(labial_voice_next(&voice, 1240, &frame, faps), LABIAL_WAITING);
    for (unsigned k = 63; k < 80; k++) {
        assert_ok(labial_voice_next(&voice, 20 * k, &frame, faps));
        assert_true(frame == k);
    }
    assert_memory_equal(faps, wanted[79], sizeof faps);
    assert_ok(labial_voice_next(&voice, LABIAL_VOICE_CLOCK, &frame, faps));
    assert_int_equal(frame, 1600000000);
}

TEST_AFTER(begin_frames, a_cancel_eases_to_rest)
{
    follow("sentence; show 900");
    assert_memory_equal(shown, wanted, 46 * sizeof *shown);
    follow("cancel 90; not done; show 960");
    assert_memory_not_equal(shown[48], rest, sizeof rest);
    follow("show 1000; done; begin 1100");
    assert_memory_equal(shown[50], rest, sizeof rest);
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_SIL, 0, 200)); /* that is nothing */
    follow("show 1200; sentence");
    assert_memory_equal(shown[60], rest, sizeof rest);
    want(1100);
    show_until(2400);
    assert_memory_equal(shown[70], wanted[70], 51 * sizeof *shown);
}

/* While the clock stands, the face goes the same way to rest as by frames, and the next answer waits for its sound. */
TEST_AFTER(begin_frames, a_face_eases_while_the_clock_stands)
{
    int16_t faps[LABIAL_CHANNELS];
    tell_sentence(0, SENTENCE);
    show_until(900);
    assert_int_equal(labial_voice_ease(&voice, faps), LABIAL_DONE); /* nothing was cancelled */
    labial_voice_t twin = voice;
    assert_ok(labial_voice_cancel(&twin, 90));
    assert_ok(labial_voice_cancel(&voice, 90));
    assert_ok(labial_voice_begin(&voice, 920, 0));
    tell_sentence(0, SENTENCE);
    for (unsigned i = 0; i < 5; i++) {
        int16_t wanted_faps[LABIAL_CHANNELS];
        assert_int_equal(labial_voice_next(&voice, 900, NULL, faps), LABIAL_WAITING);
        assert_ok(labial_voice_ease(&voice, faps));
        assert_ok(labial_voice_next(&twin, 920 + 20 * i, NULL, wanted_faps));
        assert_memory_equal(faps, wanted_faps, sizeof faps);
    }
    assert_memory_equal(faps, rest, sizeof rest);
    assert_int_equal(labial_voice_ease(&voice, faps), LABIAL_DONE);
    want(920);
    show_until(2200);
    assert_memory_equal(shown[60], wanted[60], 51 * sizeof *shown);
}

/* A clock that is the sound stops at its end: behind labial_voice_finish() the face comes to rest all the same. */
TEST_AFTER(begin_frames, a_face_comes_to_rest_at_the_end_while_the_clock_stands)
{
    static uint32_t before[COUNT_OF(memory)];
    int16_t faps[LABIAL_CHANNELS];
    follow("finish");
    assert_int_equal(labial_voice_ease(&voice, faps), LABIAL_DONE); /* nothing was shown, */
    follow("show 20");
    assert_int_equal(labial_voice_ease(&voice, faps), LABIAL_DONE); /* or is known */
    voice.finished = 0;
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_AA, 100, 1000));
    follow("show 780");
    assert_int_equal(labial_voice_ease(&voice, faps), LABIAL_DONE);
    follow("finish");
    assert_int_equal(labial_voice_ease(&voice, faps), LABIAL_DONE); /* the player waits for sound */
    follow("show 900");
    for (unsigned i = 0; i < 4; i++) /* a clock of large steps */
        assert_int_equal(labial_voice_ease(&voice, faps), LABIAL_WAITING);
    follow("show 940");
    for (unsigned i = 0; i < 19; i++) {
        follow("not done");
        assert_int_equal(labial_voice_next(&voice, 940, NULL, faps), LABIAL_WAITING);
        assert_int_equal(labial_voice_ease(&voice, faps), i < 4 ? LABIAL_WAITING : LABIAL_OK);
    }
    assert_memory_equal(faps, rest, sizeof rest);
    follow("done");
    assert_int_equal(labial_voice_ease(&voice, faps), LABIAL_DONE);
    memcpy(before, memory, sizeof memory);
    labial_voice_t twin = voice;
    follow("begin 1400; not done; sentence"); /* the next answer waits for its sound */
    want(1400);
    show_until(2580);
    assert_memory_equal(shown[80], wanted[80], 50 * sizeof *shown);
    frame_count = 48;
    memcpy(memory, before, sizeof memory);
    voice = twin; /* or the clock goes on, */
    follow("show 1600; done");
    assert_memory_equal(shown[80], rest, sizeof rest);
    frame_count = 48;
    memcpy(memory, before, sizeof memory);
    voice = twin; /* or more was told of what ended */
    follow("finish");
    voice.utterances[0].identity = 7;
    labial_voice_item_t more = { 1000 * MS, 1500 * MS, NULL, 0, SPEECH_EN_IY };
    labial_voice_message_t late = { &more, 1, 7, 0, 0, LABIAL_VOICE_PHONEMES, LABIAL_VOICE_ABSOLUTE };
    assert_ok(labial_voice_tell(&voice, &late));
    follow("not done");
    assert_int_equal(labial_voice_ease(&voice, faps), LABIAL_DONE);
    follow("show 1200");
    assert_memory_not_equal(shown[60], rest, sizeof rest);
}

TEST_AFTER(begin_frames, an_end_right_after_a_cancel_waits_for_the_face)
{
    follow("sentence; show 900; cancel 200; begin 1500; finish; not done; show 1100; done");
    assert_memory_equal(shown[55], rest, sizeof rest);
}

TEST_AFTER(begin_frames, a_cancel_before_the_first_frame)
{
    follow("cancel 100; show 200");
    assert_memory_equal(shown[0], rest, sizeof rest);
    assert_memory_equal(shown[10], rest, sizeof rest);
}

TEST_AFTER(begin_frames, done)
{
    follow("not done; finish; done; sentence; not done");   /* at first nothing was told */
    follow("finish; show 1760; not done; show 1780; done"); /* the last one ends at 1300 */
}

/* Pictures that were not drawn for seconds, as those of a hidden page: the face comes to rest before all is done. */
TEST_AFTER(begin_frames, done_after_a_jump_is_at_rest)
{
    int16_t faps[LABIAL_CHANNELS];
    follow("sentence; finish; show 500");
    assert_ok(labial_voice_next(&voice, 5000, NULL, faps));
    assert_memory_not_equal(faps, rest, sizeof rest);
    follow("not done");
    for (uint64_t heard = 5020; heard <= 5200; heard += 20)
        assert_ok(labial_voice_next(&voice, heard, NULL, faps));
    assert_memory_equal(faps, rest, sizeof rest);
    follow("done");
}

TEST_AFTER(begin_frames, a_silence_of_hours)
{
    int16_t faps[LABIAL_CHANNELS];
    tell_sentence(0, SENTENCE);
    show_until(500);
    for (uint64_t k = 1; k <= 4; k++) /* the clock jumps, and goes on for longer than an hour */
        assert_ok(labial_voice_next(&voice, 3000000 * k, NULL, faps));
    for (unsigned k = 600001; k < 600001 + 185000; k++)
        assert_ok(labial_voice_next(&voice, UINT64_C(20) * k, NULL, faps));
}

TEST_AFTER(begin_frames, phonemes_of_a_millisecond)
{
    for (unsigned i = 0; i < 400; i++)
        assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_AA + i % 2u, i, i + 1u));
    show_until(300); /* the stream was given more of them than are noted */
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_M, 350, 400));
    show_until(1000);
    assert_int_equal(frame_count, 51);
}

/* ---- Drawn sentences --------------------------------------------------------------------------------------------- */

enum { WORDS = 24 };

/* The largest distance of a word's first phoneme from where it is spoken, of messages that are told in a drawn way. */
static int64_t shift_of(fixture_random_t *random, unsigned way)
{
    static const unsigned grids[] = { 1, 1000, 1000, 10000, 20000 };
    const unsigned grid = grids[fixture_below(random, way == 3 ? 3 : 5)], spans = fixture_below(random, 3);
    uint64_t starts[WORDS + 1];
    unsigned firsts[WORDS + 1], messages = 0;
    int64_t worst = 0;
    labial_voice_segment_t segment;
    starts[0] = fixture_below(random, 400000);
    for (unsigned i = 0; i < WORDS; i++)
        starts[i + 1] = starts[i] + 60000 + fixture_below(random, 400000);
    for (unsigned i = 0; i < WORDS; i += 1u + fixture_below(random, 5))
        firsts[messages++] = i;
    firsts[messages] = WORDS;
    begin_with(PLACES);
    message.times = LABIAL_VOICE_JOINED;
    message.utterance = name("answer");
    for (unsigned m = 0; m < messages; m++) {
        const unsigned place = way == 2 && (m ^ 1u) < messages ? m ^ 1u : m; /* shuffled with the next one */
        const unsigned first = firsts[place], last = firsts[place + 1];
        const uint64_t origin = way == 3 ? starts[first] : 0; /* each from its own sound */
        for (unsigned repeat = 0; repeat < (way == 1 ? 2u : 1u); repeat++) {
            for (unsigned i = first; i < last; i++) {
                const uint64_t start = starts[i] - origin, end = starts[i + 1] - origin;
                item("M", 0, 0);
                items[i - first].phoneme = (uint8_t)(1 + i);
                items[i - first].start = (start + grid / 2) / grid * grid; /* rounded, */
                if (spans == 0) /* and so is the end, or the duration, or both are cut */
                    items[i - first].end = (end + grid / 2) / grid * grid;
                else if (spans == 1)
                    items[i - first].end = items[i - first].start + (end - start + grid / 2) / grid * grid;
                else
                    items[i - first].end = items[i - first].start + (end - start) / grid * grid;
            }
            assert_ok(tell());
        }
        message.utterance = name("stale");
        if (voice.cancelled == 0 && m == 0) /* of an answer that was interrupted before */
            labial_voice_note_over(&voice, message.utterance);
        item("AA", 0, 300);
        assert_int_equal(tell(), LABIAL_CANCELLED);
        message.utterance = name("answer");
    }
    labial_voice_plan_start(&voice, 0);
    for (unsigned i = 0; i < WORDS;) {
        int64_t distance;
        labial_voice_plan_next(&voice, &segment);
        assert_true(segment.end != INT64_MAX);
        if (segment.phoneme == SPEECH_EN_SIL)
            continue;
        assert_int_equal(segment.phoneme, 1 + i);
        distance = llabs(segment.start - (int64_t)(starts[i] / 1000) + (way == 3 ? (int64_t)(starts[0] / 1000) : 0));
        worst = distance > worst ? distance : worst;
        i++;
    }
    return worst;
}

TEST_AFTER(begin, drawn_messages_are_not_shifted)
{
    fixture_random_t random = { fixture_seed(34) };
    for (unsigned way = 0; way < 4; way++)
        for (int i = 0; i < FIXTURE_ROUNDS(1000); i++)
            assert_in_range(shift_of(&random, way), 0, 20);
}

/* ---- Misuse ------------------------------------------------------------------------------------------------------ */

TEST_AFTER(begin, misuse)
{
    static const uint8_t numbers[40] = { SPEECH_EN_SIL, SPEECH_EN_M }, wrong[40] = { 39, 40 };
    static labial_model_t other;
    static labial_words_model_t other_words;
    int16_t faps[LABIAL_CHANNELS];
    labial_voice_t none;
    memset(&none, 0, sizeof none);
    message.count = 1;
    for (unsigned i = 0; i < 2; i++) {
        labial_voice_t *const bad = i ? &none : NULL;
        const int error = i ? LABIAL_ERROR_STATE : LABIAL_ERROR_NULL;
        assert_int_equal(labial_voice_words(bad, &words_en, NULL), error);
        assert_int_equal(labial_voice_pronounce(bad, NULL, NULL), error);
        assert_int_equal(labial_voice_numbers(bad, NULL), error);
        assert_int_equal(labial_voice_offset(bad, 0), error);
        assert_int_equal(labial_voice_tell(bad, &message), error);
        assert_int_equal(labial_voice_word(bad, "a", 1, 0, 5), error);
        assert_int_equal(labial_voice_phoneme(bad, 1, 0, 5), error);
        assert_int_equal(labial_voice_begin(bad, 0, 0), error);
        assert_int_equal(labial_voice_finish(bad), error);
        assert_int_equal(labial_voice_cancel(bad, 0), error);
        assert_int_equal(labial_voice_next(bad, 0, NULL, faps), error);
        assert_int_equal(labial_voice_ease(bad, faps), error);
        assert_int_equal(labial_voice_done(bad), 0);
        assert_int_equal(labial_voice_counts(bad).told, 0);
    }
    assert_int_equal(labial_voice_tell(&voice, NULL), LABIAL_ERROR_NULL);
    message.items = NULL;
    assert_int_equal(labial_voice_tell(&voice, &message), LABIAL_ERROR_NULL);
    message.count = 0;
    assert_ok(labial_voice_tell(&voice, &message));
    message.kind = LABIAL_VOICE_CHARACTERS + 1;
    assert_int_equal(labial_voice_tell(&voice, &message), LABIAL_ERROR_RANGE);
    message.kind = 0;
    message.times = LABIAL_VOICE_JOINED + 1;
    assert_int_equal(labial_voice_tell(&voice, &message), LABIAL_ERROR_RANGE);
    assert_int_equal(labial_voice_word(&voice, NULL, 1, 0, 5), LABIAL_ERROR_NULL);
    assert_int_equal(labial_voice_words(&voice, NULL, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_voice_words(&voice, &other_words, NULL), LABIAL_ERROR_VERSION);
    assert_int_equal(labial_voice_numbers(&voice, wrong), LABIAL_ERROR_PHONEME);
    assert_int_equal(labial_voice_offset(&voice, (int32_t)LABIAL_VOICE_LATEST + 1), LABIAL_ERROR_RANGE);
    assert_int_equal(labial_voice_offset(&voice, -(int32_t)LABIAL_VOICE_LATEST - 1), LABIAL_ERROR_RANGE);
    assert_int_equal(labial_voice_begin(&voice, LABIAL_VOICE_CLOCK + 1, 0), LABIAL_ERROR_RANGE);
    assert_int_equal(labial_voice_next(&voice, LABIAL_VOICE_CLOCK + 1, NULL, faps), LABIAL_ERROR_RANGE);
    assert_int_equal(labial_voice_next(&voice, 0, NULL, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_voice_ease(&voice, NULL), LABIAL_ERROR_NULL);
    assert_ok(labial_voice_word(&voice, "a", 1, 100, LABIAL_VOICE_OPEN));
    assert_ok(labial_voice_numbers(&voice, NULL));
    assert_ok(labial_voice_numbers(&voice, numbers)); /* every word is now of silences and M */
    assert_ok(labial_voice_offset(&voice, 50));
    known();
    assert_int_equal(labial_voice_init(NULL, &speech_en, memory, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_voice_init(&voice, NULL, memory, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_voice_init(&voice, &speech_en, NULL, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_voice_init(&voice, &other, memory, sizeof memory), LABIAL_ERROR_VERSION);
    assert_int_equal(labial_voice_init(&voice, &speech_en, (char *)memory + 1, sizeof memory - 1),
                     LABIAL_ERROR_WORKSPACE);
    assert_int_equal(labial_voice_finish(&voice), LABIAL_ERROR_STATE);
    assert_ok(labial_voice_init(&voice, &speech_en, memory, SIZE_MAX / 2));
    assert_int_equal(voice.room, 0x1000000); /* that is enough */
    assert_ok(labial_voice_init(&voice, &speech_en, memory, sizeof memory));
    assert_int_equal(labial_voice_word(&voice, "a", 1, 0, 5), LABIAL_ERROR_STATE); /* no words */
}

/* Shares are those of the stream; while a frame fades they change by a quarter at most, and at rest they are silence. */
TEST_AFTER(begin, frames_tell_their_sounds)
{
    uint8_t shares[LABIAL_VISEMES] = { 0 }, before[LABIAL_VISEMES];
    int16_t faps[LABIAL_CHANNELS];
    assert_ok(labial_voice_phoneme(&voice, SPEECH_EN_TH, 200, 600));
    for (uint64_t heard = 0; heard < 400; heard += 20)
        while (labial_voice_next(&voice, heard, NULL, faps) == LABIAL_OK)
            assert_ok(labial_voice_visemes(&voice, shares));
    assert_true(shares[LABIAL_VISEME_TH] > 110);
    assert_ok(labial_voice_cancel(&voice, 200));
    for (uint64_t heard = 400; heard < 700; heard += 20) {
        while (labial_voice_next(&voice, heard, NULL, faps) == LABIAL_OK) {
            memcpy(before, shares, sizeof before);
            labial_voice_visemes(&voice, shares);
            assert_true(before[LABIAL_VISEME_TH] - shares[LABIAL_VISEME_TH] <= LABIAL_VISEME_ONE / 4);
        }
    }
    assert_int_equal(shares[LABIAL_VISEME_TH], 0);
    assert_int_equal(shares[LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
    static labial_voice_t none;
    assert_int_equal(labial_voice_visemes(&none, shares), LABIAL_ERROR_STATE);
    assert_int_equal(labial_voice_visemes(NULL, shares), LABIAL_ERROR_NULL);
    assert_int_equal(labial_voice_visemes(&voice, NULL), LABIAL_ERROR_NULL);
}

SUITE(NULL, NULL)
