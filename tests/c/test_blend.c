/*
 * test_blend.c - frames of speech and laughter made one: the equation of labial/blend.h, and closures that stay closed.
 */
#include "suite.h"
#include "labial/blend.h"
#include "labial/faps.h"

enum { JAW = 0, UPPER = 3, LOWER = 4 };

static void draw_frame(int16_t faps[LABIAL_CHANNELS], int limit)
{
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
        faps[c] = (int16_t)between(-limit, limit);
}

/* A speech frame whose opening is `opening` and whose lower lip is down by `drop`. */
static void draw_speech(int16_t faps[LABIAL_CHANNELS], int opening, int drop)
{
    draw_frame(faps, 600);
    faps[UPPER] = (int16_t)(drop - opening);
    faps[LOWER] = (int16_t)-drop;
}

/* ---- The equation in double precision, from the FAPs' numbers --------------------------------------------------- */

static double freedom(double distance, double low, double high)
{
    if (distance <= low)
        return 0;
    if (distance >= high)
        return 1;
    const double x = (distance - low) / (high - low);
    return 3 * x * x - 2 * x * x * x;
}

static double wanted(const labial_blend_t *blend, double intensity, double words, const int16_t *speech,
                     const int16_t *laugh, unsigned channel)
{
    const double lips = freedom(-(double)speech[UPPER] - speech[LOWER], blend->closed, blend->open);
    const double touch = freedom(-(double)speech[LOWER], blend->touching, blend->dropped);
    double share = blend->shares[channel] / 256.0;
    switch (labial_fap_numbers[channel]) {
    case 51:
    case 55:
    case 56:
        share *= lips;
        break;
    case 3:
        if (laugh[channel] <= speech[channel])
            break;
        share *= touch < lips ? touch : lips;
        break;
    case 52:
    case 57:
    case 58:
        share *= touch < lips ? touch : lips;
        break;
    default:
        break;
    }
    return speech[channel] + (laugh[channel] - speech[channel]) * intensity * (1 - words * (1 - share));
}

/* A table of sensible shares and limits. */
static labial_blend_t draw_table(void)
{
    labial_blend_t blend;
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
        blend.shares[c] = (uint16_t)between(0, 256);
    blend.closed = (int16_t)between(-100, 200);
    blend.open = (int16_t)(blend.closed + between(1, 300));
    blend.touching = (int16_t)between(-100, 200);
    blend.dropped = (int16_t)(blend.touching + between(1, 300));
    return blend;
}

/* Would catch a channel in the wrong group, a limit or a factor that is left out, and lost precision. */
TEST(follows_the_equation)
{
    int16_t speech[LABIAL_CHANNELS], laugh[LABIAL_CHANNELS], out[LABIAL_CHANNELS];
    double worst = 0;
    draw_from(1);
    for (int i = 0; i < 50000; i++) {
        const labial_blend_t blend = i % 2 ? labial_blend_default : draw_table();
        const unsigned intensity = (unsigned)between(0, 256), words = (unsigned)(i % 3 ? 256 : between(0, 256));
        if (i % 5)
            draw_speech(speech, between(-100, 600), between(-100, 500));
        else
            draw_frame(speech, 2000);
        draw_frame(laugh, i % 5 ? 300 : 2000);
        assert_ok(labial_blend(&blend, intensity, words, speech, laugh, out));
        for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
            const double off = fabs(out[c] - wanted(&blend, intensity / 256.0, words / 256.0, speech, laugh, c));
            worst = off > worst ? off : worst;
        }
    }
    assert_true(worst <= 1.0);
}

/* Would catch a laugh that leaks into plain speech, or speech into a laugh without words. */
TEST(the_ends_are_exact)
{
    int16_t speech[LABIAL_CHANNELS], laugh[LABIAL_CHANNELS], out[LABIAL_CHANNELS];
    draw_from(2);
    for (int i = 0; i < 20000; i++) {
        const labial_blend_t blend = i % 2 ? labial_blend_default : draw_table();
        draw_frame(speech, i % 3 ? 600 : 32767);
        draw_frame(laugh, i % 3 ? 300 : 32767);
        assert_ok(labial_blend(&blend, 0, (unsigned)between(0, 256), speech, laugh, out));
        assert_memory_equal(out, speech, sizeof out);
        assert_ok(labial_blend(&blend, LABIAL_BLEND_FULL, 0, speech, laugh, out));
        assert_memory_equal(out, laugh, sizeof out);
    }
}

/* Lips that are far open and a table of whole shares: the laugh alone, however far apart the two are. Would catch a
 * freedom that ends just below one, which moves nothing where frames are near each other. */
TEST(open_lips_follow_wholly)
{
    int16_t speech[LABIAL_CHANNELS], laugh[LABIAL_CHANNELS], out[LABIAL_CHANNELS];
    draw_from(9);
    for (int i = 0; i < 2000; i++) {
        labial_blend_t blend = draw_table();
        for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
            blend.shares[c] = LABIAL_BLEND_FULL;
        draw_frame(speech, 32767);
        draw_frame(laugh, 32767);
        speech[3] = (int16_t)between(-32767, 0); /* the middle of the upper lip, and of the lower one */
        speech[4] = (int16_t)between(-32767, -1000);
        assert_ok(labial_blend(&blend, LABIAL_BLEND_FULL, LABIAL_BLEND_FULL, speech, laugh, out));
        assert_memory_equal(out, laugh, sizeof out);
    }
}

/* Whatever the laugh does and however loud it is: lips that meet in speech meet in the same place, and the jaw does not
 * open any further than it does in speech. */
TEST(closures_are_kept)
{
    static const uint8_t upper[] = { 3, 7, 8 }, lower[] = { 4, 9, 10 };
    int16_t speech[LABIAL_CHANNELS], laugh[LABIAL_CHANNELS], out[LABIAL_CHANNELS];
    draw_from(3);
    for (int i = 0; i < 60000; i++) {
        const labial_blend_t blend = i % 2 ? labial_blend_default : draw_table();
        const int closed = i % 4 < 2; /* else it is the lower lip at the teeth */
        if (closed)
            draw_speech(speech, i % 3 ? between(-500, blend.closed) : blend.closed, between(-500, 500));
        else
            draw_speech(speech, between(-500, 500), i % 3 ? between(-500, blend.touching) : blend.touching);
        draw_frame(laugh, i % 5 ? 400 : 32767);
        assert_ok(labial_blend(&blend, (unsigned)between(0, 300), 256, speech, laugh, out));
        for (unsigned c = 0; c < sizeof lower; c++)
            assert_int_equal(out[lower[c]], speech[lower[c]]);
        assert_true(out[JAW] <= speech[JAW]);
        for (unsigned c = 0; closed && c < sizeof upper; c++)
            assert_int_equal(out[upper[c]], speech[upper[c]]);
    }
}

/* Corners at full intensity, whose share of the way is 1 - words (256 - share) / 2^16 exactly: rounded to the nearest FAP
 * unit, half of one towards the laugh. Of each odd share, every remainder of 2^16 comes once. Would catch a half that is
 * off by the least that can be. */
TEST(what_is_free_is_rounded_to_the_nearest)
{
    static const uint8_t corners[] = { 5, 6, 11, 12 };
    static const uint16_t shares[] = { 1, 101, 203, 255 };
    int16_t speech[LABIAL_CHANNELS] = { 0 }, laugh[LABIAL_CHANNELS], out[LABIAL_CHANNELS];
    labial_blend_t blend = labial_blend_default;
    const unsigned words = 255;
    for (unsigned i = 0; i < 4; i++)
        blend.shares[corners[i]] = shares[i];
    for (int way = 0; way <= 65535; way++) {
        for (unsigned i = 0; i < LABIAL_CHANNELS; i++) { /* up and down */
            speech[i] = (int16_t)(i % 2 ? INT16_MIN : INT16_MAX);
            laugh[i] = (int16_t)(i % 2 ? INT16_MIN + way : INT16_MAX - way);
        }
        assert_ok(labial_blend(&blend, LABIAL_BLEND_FULL, words, speech, laugh, out));
        for (unsigned i = 0; i < 4; i++) {
            const double gone = way * (1.0 - words * (256.0 - shares[i]) / 65536.0);
            const unsigned c = corners[i];
            assert_int_equal(c % 2 ? out[c] - speech[c] : speech[c] - out[c], (int)floor(gone + 0.5));
        }
    }
}

/* Would catch any overflow: a value beyond both of those that it was made of. */
TEST(extremes_stay_between)
{
    static const int16_t ends[] = { INT16_MIN, INT16_MIN + 1, -1, 0, 1, INT16_MAX - 1, INT16_MAX };
    static const unsigned levels[] = { 0, 1, 127, 128, 255, 256, 257, 65536, UINT32_MAX };
    int16_t speech[LABIAL_CHANNELS], laugh[LABIAL_CHANNELS], out[LABIAL_CHANNELS];
    labial_blend_t blend;
    draw_from(5);
    for (int i = 0; i < 100000; i++) {
        blend = labial_blend_default;
        if (i % 2) {
            for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
                blend.shares[c] = (uint16_t)between(0, 65535);
            blend.closed = ends[between(0, 6)];
            blend.open = ends[between(0, 6)];
            blend.touching = ends[between(0, 6)];
            blend.dropped = ends[between(0, 6)];
        }
        for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
            speech[c] = ends[between(0, 6)];
            laugh[c] = ends[between(0, 6)];
        }
        assert_ok(labial_blend(&blend, levels[between(0, 8)], levels[between(0, 8)], speech, laugh, out));
        for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
            assert_true(out[c] >= (speech[c] < laugh[c] ? speech[c] : laugh[c]));
            assert_true(out[c] <= (speech[c] < laugh[c] ? laugh[c] : speech[c]));
        }
    }
}

TEST(in_place_and_beyond_full)
{
    int16_t speech[LABIAL_CHANNELS], laugh[LABIAL_CHANNELS], out[LABIAL_CHANNELS], same[LABIAL_CHANNELS];
    draw_from(7);
    for (int i = 0; i < 1000; i++) {
        const unsigned intensity = (unsigned)between(0, 256), words = (unsigned)between(0, 256);
        draw_frame(speech, 300);
        draw_frame(laugh, 300);
        labial_blend(&labial_blend_default, intensity, words, speech, laugh, out);
        memcpy(same, laugh, sizeof same);
        assert_ok(labial_blend(&labial_blend_default, intensity, words, speech, same, same));
        assert_memory_equal(same, out, sizeof out);
        memcpy(same, speech, sizeof same);
        assert_ok(labial_blend(&labial_blend_default, intensity, words, same, laugh, same));
        assert_memory_equal(same, out, sizeof out);
        labial_blend(&labial_blend_default, 256, 256, speech, laugh, out);
        labial_blend(&labial_blend_default, 257, 4000000000u, speech, laugh, same);
        assert_memory_equal(same, out, sizeof out);
    }
}

TEST(null_writes_nothing)
{
    const int16_t in[LABIAL_CHANNELS] = { 1, 2, 3 };
    int16_t out[LABIAL_CHANNELS], kept[LABIAL_CHANNELS];
    memset(out, 0x33, sizeof out);
    memcpy(kept, out, sizeof out);
    assert_int_equal(labial_blend(NULL, 1, 1, in, in, out), LABIAL_ERROR_NULL);
    assert_int_equal(labial_blend(&labial_blend_default, 1, 1, NULL, in, out), LABIAL_ERROR_NULL);
    assert_int_equal(labial_blend(&labial_blend_default, 1, 1, in, NULL, out), LABIAL_ERROR_NULL);
    assert_int_equal(labial_blend(&labial_blend_default, 1, 1, in, in, NULL), LABIAL_ERROR_NULL);
    assert_memory_equal(out, kept, sizeof out);
}

SUITE(NULL, NULL)
