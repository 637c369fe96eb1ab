/*
 * test_contact.c - contact and rest, from phonemes to targets: cases worked by hand from the rules of labial/model.h, and
 * random streams against oracle_steps.c, which puts contact upon the whole stream phoneme by phoneme.
 */
#include "suite.h"
#include "oracle.h"
#include "shape.h"
#include "units.h"

#define COUNT 60
#define MANY 6000

/* Of the model whose cases are worked by hand: where lips meet, and where the lower lip meets the teeth. */
enum { LIPS = 0, TEETH = 1 };

static fixture_model_t f;

/* Every target is 0 but for floors. P closes LIPS, S is to be an f and closes TEETH; both have a floor for the jaw that is
 * none of contact. O has a plain floor for LIPS. In a pause LIPS come to -800, the jaw stays above -5. */
SETUP(setup)
{
    static const int16_t floors[4][3] = { { 1000, LABIAL_NO_FLOOR, 100 },
                                          { 500, LABIAL_NO_FLOOR, LABIAL_NO_FLOOR },
                                          { LABIAL_NO_FLOOR, 700, 200 },
                                          { -800, LABIAL_NO_FLOOR, -5 } };
    fixture_plain(&f);
    memset(f.shapes, 0, sizeof f.shapes);
    f.model.floor_count = FIXTURE_FLOORS;
    f.model.floors = f.floors;
    f.model.contacts = f.contacts;
    for (unsigned i = 0; i < FIXTURE_FLOORS * LABIAL_CHANNELS; i++)
        f.floors[i] = LABIAL_NO_FLOOR;
    for (unsigned i = 0; i < FIXTURE_FLOORS; i++)
        memcpy(f.floors + i * LABIAL_CHANNELS, floors[i], sizeof floors[i]);
    f.phonemes[FIXTURE_P].floor = 1;
    f.phonemes[FIXTURE_O].floor = 2;
    f.phonemes[FIXTURE_S].floor = 3;
    f.phonemes[FIXTURE_SIL].floor = 4;
    f.contacts[0] = 1u << LIPS;
    f.contacts[2] = 1u << TEETH;
    f.contacts[3] = 1u << LIPS;
    return 0;
}

#if LABIAL_REACH >= LABIAL_CONTACT_FRAMES

static fixture_model_t other;
static const labial_model_t *models[LABIAL_MODELS > 1 ? LABIAL_MODELS : 2];
static labial_units_t units;
static int16_t targets[MANY][LABIAL_CHANNELS];
static uint16_t contacts[MANY];

/* Empties the queue of streams of these two. */
static void begin(const labial_model_t *model)
{
    fixture_laughter(&other);
    models[0] = model;
    models[1] = &other.model;
    labial_units_reset(&units);
}

/* Takes and aims at all frames of what was pushed, and returns their number. */
static size_t aim(void)
{
    labial_taken_t taken;
    labial_spoken_t spoken;
    labial_shape_t shape[LABIAL_CHANNELS] = { { { 0, 0 } } };
    size_t n = 0;
    for (;;) {
        if (units.count > 0 && labial_units_left(&units, models) == 0) {
            assert_int_equal(labial_units_next(&units, models, 1, &spoken), 1);
            oracle_shape(models[spoken.slot], spoken.phoneme, spoken.ms, spoken.previous, spoken.next, shape);
        }
        if (labial_units_take(&units, models, 1, &taken) != LABIAL_OK)
            return n;
        assert_true(n < MANY);
        contacts[n] = (uint16_t)labial_shape_target(models[taken.slot], shape, &taken, targets[n]);
        n++;
    }
}

/* Pushes phonemes that are told by letter and frames, as "T3 P1 T3", and aims. `x` is the other model's. */
static size_t speak(const char *text)
{
    static const char letters[] = "_aopft";
    begin(&f.model);
    while (*text) {
        const char *at = strchr(letters, *text);
        unsigned frames = 0;
        for (text++; *text >= '0' && *text <= '9'; text++)
            frames = frames * 10 + (unsigned)(*text - '0');
        (void)labial_units_push(&units, at ? (unsigned)(at - letters) : FIXTURE_HA, !at, frames * 1000 / FIXTURE_RATE,
                                FIXTURE_RATE);
        text += *text == ' ';
    }
    return aim();
}

/* Where a channel is in contact, frame by frame: `x`, else `.`; there it is at `floor` too. */
static void expect(const char *text, unsigned channel, int floor, const char *wanted)
{
    static char found[MANY + 1];
    const size_t n = speak(text);
    for (size_t t = 0; t < n; t++) {
        found[t] = contacts[t] >> channel & 1 ? 'x' : '.';
        if (found[t] == 'x' && targets[t][channel] != floor)
            fail_msg("%s: frame %zu is in contact at %d, not %d", text, t, targets[t][channel], floor);
    }
    found[n] = 0;
    if (strcmp(found, wanted) != 0)
        fail_msg("%s, channel %u: %s, not %s", text, channel, found, wanted);
}

/* By hand. A contact lasts for half of its phoneme, rounded up, but for three frames at least, which it borrows from what
 * is beside it, and for all but seven. Would catch a frame too few or too many, at either side, or one that lies
 * elsewhere. */
TEST(contacts_have_their_frames)
{
    static const struct {
        const char *text, *lips, *teeth; /* of teeth null: not looked at */
    } cases[] = {
        { "t3 p0 t3", "......", NULL },
        { "t3 p1 t3", "..xxx..", NULL },
        { "t3 p2 t3", "..xxx...", NULL },
        { "t3 p3 t3", "...xxx...", NULL },
        { "t3 p4 t3", "...xxx....", NULL },
        { "t3 p5 t3", "....xxx....", NULL },
        { "t3 p7 t3", "....xxxx.....", NULL },
        { "t3 p8 t3", ".....xxxx.....", NULL },
        { "t3 p13 t3", "......xxxxxxx......", NULL },
        { "t3 p14 t3", "......xxxxxxx.......", NULL },
        { "t3 p15 t3", "......xxxxxxxx.......", NULL },
        { "t1 p1 t1 p1 t1", "xxxxx", NULL },
        { "t3 p1 p1 t3", "..xxx...", NULL }, /* two that follow one another are one contact */
        { "t3 p9 p1 t3", ".....xxxxx..x...", NULL },
        { "t3 p3 p3 p3 p3 t3", "...xxxxxxxxxxxx...", NULL },
        { "t2 o1 t2", ".....", NULL }, /* a plain floor is none */
        { "t3 f2 p1 t3", "....xxx..", "..xxx...." },
        { "t3 f4 p4 t3", ".......xxx....", "...xxx........" },
        { "f1 p1", "xx", "xx" },
        { "p1", "x", NULL }, /* there is nothing to borrow before a stream's first frame and behind its last */
        { "p1 t3", "xx..", NULL },
        { "t3 p2", "..xxx", NULL },
        { "p20", "...xxxxxxxxxxxxx....", NULL },
        { "_20 p1 _20", "...................xxx...................", NULL },
        { "_2 p1 _2", ".xxx.", NULL },
#if LABIAL_MODELS > 1
        { "x3 p1 t2", "...xx.", NULL }, /* nor from another model */
        { "t2 p2 x3 p1 x1", ".xxx...x.", NULL },
#endif
    };
    assert_ok(labial_model_check(&f.model));
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        expect(cases[i].text, LIPS, 1000, cases[i].lips);
        if (cases[i].teeth)
            expect(cases[i].text, TEETH, 700, cases[i].teeth);
    }
}

/* What lies between two contacts is FAP 52 100 units below the contact at most, where neither borrows it; would
 * catch lips that part too far from a contact, in a pause, or where a contact has just been borrowed. */
TEST(close_contacts_are_told_apart)
{
    static const struct {
        const char *text, *where; /* p of contact, o where the lips part */
    } cases[] = {
        { "p3 t1 p3", "pppoppp" },     { "p3 t2 p3", "pppooppp" },    { "p3 t3 p3", "pppoooppp" },
        { "p3 t4 p3", "ppp....ppp" },  { "p3 t1 a1 p3", "pppooppp" }, { "p3 t2 p2", "pppoppp" },
        { "p3 t1 p2", "pppppp" },      { "p1 t3 p3", "ppooppp" },     { "p3 _1 p3", "ppp.ppp" },
        { "p3 t1 _1 p3", "ppp..ppp" }, { "p3 t2 f3", "ppp..fff" },    { "t2 p3 t2", "..ppp.." },
        { "p4 t1 p4", "ppp.oppp." },   { "p5 t2 p3", ".ppp.ooppp" },
    };
    const unsigned channel = 4, at = FIXTURE_P;
    int16_t *floor = f.floors + (f.phonemes[at].floor - 1) * LABIAL_CHANNELS;
    floor[channel] = 1000;
    f.contacts[0] = 1u << channel;
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const size_t n = speak(cases[i].text);
        assert_int_equal(n, strlen(cases[i].where));
        for (size_t t = 0; t < n; t++) {
            const int where = cases[i].where[t], wanted = where == 'p' ? 1000 : where == 'o' ? 1000 - 1600 : 0;
            if (targets[t][channel] != wanted || (contacts[t] >> channel & 1) != (where == 'p'))
                fail_msg("%s, frame %zu: %d, not %d", cases[i].text, t, targets[t][channel], wanted);
        }
    }
    floor[channel] = -16000; /* no position lies lower than the least */
    assert_int_equal(speak("p3 t1 p3"), 7);
    assert_int_equal(targets[3][channel], -LABIAL_POSITION_MAX);
    floor[channel] = LABIAL_NO_FLOOR;
    f.contacts[0] = 1u << LIPS;
    speak("p3 t1 p3"); /* a channel that does not move the lips is not parted */
    assert_int_equal(targets[3][LIPS], 0);
}

/* Would catch a rule that holds alone and not beside the others: every frame of random streams, all of a rich model. */
TEST(random_streams_keep_contact)
{
    static fixture_model_t rich;
    static fixture_phoneme_t input[COUNT];
    static oracle_frame_t frames[MANY];
    static int16_t wanted[MANY][LABIAL_CHANNELS];
    static uint16_t touched[MANY];
    unsigned touching = 0;
    fixture_rich(&rich);
    for (unsigned seed = 0; seed < FIXTURE_ROUNDS(300); seed++) {
        const unsigned phonemes = COUNT < LABIAL_QUEUE ? COUNT : LABIAL_QUEUE;
        fixture_stream(input, phonemes, seed % 4 ? FIXTURE_CONTACTS : FIXTURE_PAUSES, seed);
        begin(&rich.model);
        for (unsigned i = 0; i < phonemes; i++) {
            input[i].ms %= 1000;
            input[i].model = (uint8_t)(LABIAL_MODELS > 1 && seed % 3 == 0 && i / 7 % 2);
            input[i].phoneme =
                (uint8_t)(input[i].phoneme % (input[i].model ? FIXTURE_LAUGH_COUNT : FIXTURE_SPEECH_COUNT));
            (void)labial_units_push(&units, input[i].phoneme, input[i].model, input[i].ms, FIXTURE_RATE);
        }
        const size_t count = oracle_units(models, input, phonemes, frames, MANY);
        oracle_targets(models, frames, count, wanted, touched);
        assert_int_equal(aim(), count);
        assert_memory_equal(contacts, touched, count * sizeof *contacts);
        assert_memory_equal(targets, wanted, count * sizeof *targets);
        for (size_t t = 0; t < count; t++)
            touching += contacts[t] != 0;
    }
    assert_true(touching > FIXTURE_ROUNDS(5000));
}

#else

/* Would catch a library that reads beyond its labels: it cannot see whether a contact is short. */
TEST(a_library_that_sees_too_little_refuses_floors)
{
    assert_int_equal(labial_model_check(&f.model), LABIAL_ERROR_MODEL);
    f.model.floor_count = 0;
    f.phonemes[FIXTURE_P].floor = f.phonemes[FIXTURE_O].floor = 0;
    f.phonemes[FIXTURE_S].floor = f.phonemes[FIXTURE_SIL].floor = 0;
    assert_ok(labial_model_check(&f.model));
}

#endif

SUITE(setup, NULL)
