/*
 * test_beside.c - lips that come beside their sound (labial/beside.h), against a player that has an array of all frames
 * and counts in 64 bits: lost, late and doubled packets, clocks that jitter, stand still and wrap, cancels.
 */
#include "suite.h"
#include "labial/beside.h"

enum { HOLD = LABIAL_BESIDE_HOLD, EASE = LABIAL_BESIDE_EASE, OUTPUTS = 3, ROOM = 64, RATE = 24000, STEP = RATE / 50 };

static labial_beside_t player;
static uint8_t memory[LABIAL_BESIDE_SIZE(OUTPUTS, ROOM)];
static uint8_t packet[LABIAL_BESIDE_LONGEST];
static const uint8_t at_rest[OUTPUTS] = { 10, 128, 250 };
static uint16_t session; /* of the packets that are made */

/* What frame `frame` shows. */
static uint8_t value_of(uint64_t frame, unsigned output)
{
    return (uint8_t)(frame * 37u + output * 85u + (frame >> 8) * 11u);
}

static size_t make_packet(int cancels, unsigned outputs, unsigned count, uint64_t first)
{
    size_t size = 0;
    packet[size++] = LABIAL_BESIDE_FORMAT;
    packet[size++] = (uint8_t)cancels;
    packet[size++] = (uint8_t)outputs;
    packet[size++] = (uint8_t)count;
    for (unsigned i = 0; i < 4; i++)
        packet[size++] = (uint8_t)(first >> 8 * i);
    packet[size++] = (uint8_t)session;
    packet[size++] = (uint8_t)(session >> 8);
    for (unsigned i = 0; i < outputs; i++)
        packet[size++] = at_rest[i % OUTPUTS];
    for (unsigned k = 0; k < count; k++)
        for (unsigned i = 0; i < outputs; i++)
            packet[size++] = value_of(first + k, i);
    return size;
}

static int feed(int cancels, unsigned count, uint64_t first)
{
    return labial_beside_push(&player, packet, make_packet(cancels, OUTPUTS, count, first));
}

SETUP(begin)
{
    draw_from(1);
    session = 0x1234;
    memset(memory, 0xa5, sizeof memory);
    return labial_beside_init(&player, OUTPUTS, RATE, memory, sizeof memory) == LABIAL_OK ? 0 : -1;
}

static void assert_shows(uint32_t sample, uint64_t frame)
{
    uint8_t values[OUTPUTS];
    assert_ok(labial_beside_tick(&player, sample, values));
    for (unsigned i = 0; i < OUTPUTS; i++)
        assert_int_equal(values[i], value_of(frame, i));
}

static void assert_rests(uint32_t sample)
{
    uint8_t values[OUTPUTS];
    assert_int_equal(labial_beside_tick(&player, sample, values), LABIAL_STARVED);
    assert_memory_equal(values, at_rest, OUTPUTS);
}

/* Catches a frame that is shown a sample too early or too late, an overflow of samples times 50, and numbers that are
 * wrong after 2^32 samples, or after as many frames. */
TEST_AFTER(begin, frames_come_with_their_samples)
{
    static const uint32_t rates[] = { 50, 8000, 11025, 16000, 22050, 24000, 44100, 48000, 192000, 50000000 };
    for (unsigned r = 0; r < COUNT_OF(rates); r++) {
        const uint64_t rate = rates[r], most = (rate == 50 ? 3u : 1u) * (UINT64_C(1) << 33);
        uint64_t sample = 0;
        assert_int_equal(labial_beside_init(&player, OUTPUTS, rates[r], memory, sizeof memory), 0);
        assert_ok(feed(0, 0, 0));
        while (sample < most) {
            const uint64_t frame = sample * 50 / rate, next = ((frame + 1) * rate + 49) / 50;
            uint8_t values[OUTPUTS];
            (void)labial_beside_tick(&player, (uint32_t)sample, values); /* so that the window is there */
            assert_ok(feed(0, 2, frame));
            assert_shows((uint32_t)(next - 1), frame);
            assert_shows((uint32_t)next, frame + 1);
            sample = next + below(8) * (rate / 3) + below(1000) + (below(4) ? 0 : below(1u << 24) * UINT64_C(100));
        }
    }
}

/* Catches what no packet is, and changes by it. */
TEST_AFTER(begin, other_packets_are_refused)
{
    const size_t size = make_packet(0, OUTPUTS, 4, 0);
    uint8_t values[OUTPUTS], saved[64];
    labial_beside_t before;
    assert_int_equal(labial_beside_tick(&player, 0, values), LABIAL_ERROR_STATE);
    memcpy(saved, packet, size);
    before = player;
    for (size_t cut = 0; cut <= size + 3; cut++)
        if (cut != size)
            assert_int_equal(labial_beside_push(&player, packet, cut), LABIAL_ERROR_PACKET);
    static const uint8_t others[][2] = { { 0, 0 }, { 0, 1 }, { 0, 3 }, { 1, 2 }, { 1, 128 },
                                         { 2, 2 }, { 2, 4 }, { 3, 3 }, { 3, 5 } };
    for (unsigned i = 0; i < COUNT_OF(others); i++) {
        memcpy(packet, saved, size);
        packet[others[i][0]] = others[i][1];
        assert_int_equal(labial_beside_push(&player, packet, size), LABIAL_ERROR_PACKET);
    }
    assert_memory_equal(&player, &before, sizeof player);
    for (size_t i = 0; i < sizeof memory; i++)
        assert_int_equal(memory[i], i / OUTPUTS == 3 ? 255 : 0); /* no limits */
    memcpy(packet, saved, size);
    assert_ok(labial_beside_push(&player, packet, size));
    assert_shows(0, 0);
}

TEST(null_pointers_and_wrong_sizes_are_refused)
{
    uint8_t values[OUTPUTS];
    uint8_t *const large = (uint8_t *)fixture_room(LABIAL_BESIDE_SIZE(1, 70000), 1);
    memset(&player, 0, sizeof player);
    for (unsigned i = 0; i < 2; i++) {
        labial_beside_t *const bad = i ? &player : NULL;
        const int error = i ? LABIAL_ERROR_STATE : LABIAL_ERROR_NULL;
        assert_int_equal(labial_beside_push(bad, packet, 9), error);
        assert_int_equal(labial_beside_cancel(bad, 120), error);
        assert_int_equal(labial_beside_tick(bad, 0, values), error);
        assert_int_equal(labial_beside_restart(bad, RATE), error);
        assert_int_equal(labial_beside_limit(bad, 0, 1), error);
    }
    assert_int_equal(labial_beside_init(NULL, 1, RATE, memory, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_beside_init(&player, 1, RATE, NULL, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_beside_init(&player, 0, RATE, memory, sizeof memory), LABIAL_ERROR_RANGE);
    assert_int_equal(labial_beside_init(&player, 256, RATE, large, 70000), LABIAL_ERROR_RANGE);
    assert_int_equal(labial_beside_init(&player, 1, 0, memory, sizeof memory), LABIAL_ERROR_SAMPLE_RATE);
    assert_int_equal(labial_beside_init(&player, 1, 50000001, memory, sizeof memory), LABIAL_ERROR_SAMPLE_RATE);
    assert_int_equal(labial_beside_init(&player, OUTPUTS, RATE, memory, LABIAL_BESIDE_SIZE(OUTPUTS, 1) - 1),
                     LABIAL_ERROR_WORKSPACE);
    assert_int_equal(labial_beside_push(&player, packet, 9), LABIAL_ERROR_STATE);
    assert_int_equal(labial_beside_init(&player, 255, RATE, large, 70000), 0);
    for (unsigned frames = 1; frames < 300; frames++) {
        assert_int_equal(labial_beside_init(&player, 1, RATE, large, LABIAL_BESIDE_SIZE(1, frames)), 0);
        assert_true(player.frames <= frames && player.frames * 2u > frames &&
                    (player.frames & (player.frames - 1)) == 0);
        assert_int_equal(labial_beside_init(&player, 1, RATE, large, LABIAL_BESIDE_SIZE(1, frames + 1) - 1), 0);
        assert_true(player.frames <= frames);
    }
    assert_int_equal(labial_beside_init(&player, 1, RATE, large, LABIAL_BESIDE_SIZE(1, 70000)), 0);
    assert_int_equal(player.frames, LABIAL_BESIDE_FRAMES_MAX);
    assert_int_equal(labial_beside_push(&player, NULL, 9), LABIAL_ERROR_NULL);
    assert_int_equal(labial_beside_restart(&player, 0), LABIAL_ERROR_SAMPLE_RATE);
    assert_int_equal(labial_beside_restart(&player, 50000001), LABIAL_ERROR_SAMPLE_RATE);
    assert_ok(labial_beside_restart(&player, 50000000));
    assert_int_equal(labial_beside_limit(&player, 1, 1), LABIAL_ERROR_RANGE);
    assert_int_equal(labial_beside_limit(&player, 0, 0), LABIAL_ERROR_RANGE);
    assert_int_equal(labial_beside_limit(&player, 0, 256), LABIAL_ERROR_RANGE);
    assert_ok(labial_beside_limit(&player, 0, 255));
    assert_int_equal(labial_beside_tick(&player, 0, NULL), LABIAL_ERROR_NULL);
    free(large);
}

/* Catches a clock that is taken for a new beginning when it jitters, or for jitter when it begins anew, and one that does
 * not know whether it goes forwards. */
TEST_AFTER(begin, a_clock_may_go_back)
{
    const uint32_t farthest = 0x7fffffff;
    const uint64_t last = farthest * UINT64_C(50) / RATE;
    const uint32_t back = 0u - (uint32_t)((farthest + UINT64_C(1)) * 50 / RATE + 1);
    uint8_t values[OUTPUTS];
    assert_int_equal(feed(0, 10, 0), 0);
    assert_int_equal(labial_beside_tick(&player, 100 * STEP, values), LABIAL_STARVED);
    assert_int_equal(feed(0, 10, 100), 0);
    assert_int_equal(labial_beside_tick(&player, (100 - ROOM + 1) * STEP, values), LABIAL_STARVED);
    assert_shows(100 * STEP, 100);
    assert_ok(labial_beside_tick(&player, (100 - ROOM) * STEP, values)); /* holds */
    assert_int_equal(feed(0, 10, 100 - ROOM), 0);
    assert_shows((100 - ROOM) * STEP, 100 - ROOM);
    assert_int_equal(begin(NULL), 0);
    assert_int_equal(feed(0, 1, 0), 0);
    assert_shows(0, 0);
    (void)labial_beside_tick(&player, farthest, values);
    assert_int_equal(feed(0, 1, last), 0);
    assert_shows(farthest, last);
    assert_int_equal(begin(NULL), 0);
    assert_int_equal(feed(0, 1, 0), 0);
    assert_shows(0, 0);
    (void)labial_beside_tick(&player, farthest + 1, values);
    assert_int_equal(feed(0, 1, back), 0);
    assert_shows(farthest + 1, back);
}

/* Catches a frame that keeps what an earlier packet said, and one that changes while it is shown. */
TEST_AFTER(begin, a_later_packet_replaces_frames)
{
    const size_t size = make_packet(0, OUTPUTS, 10, 0);
    uint8_t values[OUTPUTS];
    assert_int_equal(labial_beside_push(&player, packet, size), 0);
    assert_shows(0, 0);
    memset(packet + LABIAL_BESIDE_HEAD + OUTPUTS, 99, size - LABIAL_BESIDE_HEAD - OUTPUTS);
    assert_int_equal(labial_beside_push(&player, packet, size), 0);
    assert_shows(1, 0);
    assert_ok(labial_beside_tick(&player, STEP, values));
    for (unsigned i = 0; i < OUTPUTS; i++)
        assert_int_equal(values[i], 99);
}

/* Catches a cancel of untrusted numbers after which nothing is shown any more. */
TEST_AFTER(begin, a_cancel_far_ahead_heals)
{
    assert_int_equal(feed(0, 50, 0), 0);
    assert_shows(0, 0);
    assert_int_equal(feed(1, 0, 0x7ffffff0), LABIAL_CANCELLED);
    uint8_t values[OUTPUTS];
    assert_int_equal(labial_beside_tick(&player, STEP, values), LABIAL_STARVED);
    assert_int_equal(feed(0, 50, 2), 0);
    assert_shows(2 * STEP, 2);
    assert_int_equal(feed(1, 1, 0), LABIAL_CANCELLED); /* one of long ago moves no window */
    assert_int_equal(feed(0, 1, 4), 0);
    assert_shows(4 * STEP, 4);
}

/* Catches a cancel that does not know whether its number lies ahead, after which its frames have no room. */
TEST(a_cancel_reaches_across_the_end_of_numbers)
{
    static const uint32_t from[] = { 0xfffffff0u, 5, 1000 }, ahead[] = { 70, 0x7fffffff, 0x80000000u };
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t to = from[i] + ahead[i];
        uint8_t values[OUTPUTS];
        assert_int_equal(labial_beside_init(&player, OUTPUTS, 50, memory, sizeof memory), 0); /* a sample is a frame */
        assert_int_equal(feed(0, 0, 0), 0);
        (void)labial_beside_tick(&player, from[i], values);
        assert_int_equal(feed(1, 0, to), LABIAL_CANCELLED);
        if (ahead[i] < 0x80000000u) {
            assert_int_equal(feed(0, 1, to), 0);
            assert_shows(to, to);
        } else {
            assert_int_equal(feed(0, 1, from[i]), 0);
            assert_shows(from[i], from[i]);
        }
    }
}

/* Catches a new server, after any time, whose numbers are taken for late or early ones of the one before; sessions that
 * differ in one of their bytes; frames of the one before; and a face that jumps when it begins. */
TEST(a_session_begins_whatever_its_numbers)
{
    static const uint64_t heard[] = { 0,          40,         1000000,    0x7fffffff,
                                      0x80000000, 2419200000, 0xffffffff, UINT64_C(0x1234567890) };
    static const uint16_t other[] = { 0x1281, 0x1380, 0 };
    for (unsigned i = 0; i < 64 * 3; i++) {
        const uint64_t from = heard[i % 8] / STEP, to = heard[i / 8 % 8] / STEP;
        uint8_t values[OUTPUTS];
        assert_int_equal(begin(NULL), 0);
        session = 0x1280;
        assert_ok(feed(0, 50, from)); /* also from the middle of one */
        for (unsigned k = 0; k < 20; k++)
            assert_shows((uint32_t)((from + k) * STEP), from + k);
        session = other[i / 64];
        assert_int_equal(feed(0, 20, to), LABIAL_NEW_SESSION);
        assert_ok(feed(0, 10, to + 20));
        for (unsigned k = 0; k < 30; k++)
            assert_shows((uint32_t)((to + k) * STEP), to + k);
        session++;
        assert_int_equal(feed(1, 0, 7), LABIAL_NEW_SESSION); /* a cancel, too */
        assert_int_equal(feed(1, 0, 7), LABIAL_CANCELLED);
        for (unsigned k = 0; k < EASE; k++) {
            assert_int_equal(labial_beside_tick(&player, 0, values), LABIAL_STARVED);
            assert_int_equal(memcmp(values, at_rest, OUTPUTS) == 0, k == EASE - 1);
        }
    }
}

/* Catches a connection whose numbers are those of the one before, or whose face jumps to rest. */
TEST_AFTER(begin, a_connection_begins_with_other_numbers)
{
    const uint32_t late = UINT32_C(2419200000); /* 14 hours at 48 kHz */
    uint8_t values[OUTPUTS];
    assert_ok(labial_beside_restart(&player, RATE));
    assert_int_equal(labial_beside_tick(&player, 0, values), LABIAL_ERROR_STATE); /* nothing is known yet */
    session = 0;
    assert_int_equal(feed(0, 0, 0), 0);
    assert_rests(0);
    assert_ok(labial_beside_restart(&player, RATE));
    assert_int_equal(feed(0, 10, late / STEP), 0);
    assert_shows(late, late / STEP);
    assert_int_equal(begin(NULL), 0);
    session = 0;
    assert_int_equal(feed(0, 10, late / STEP), 0);
    assert_shows(late, late / STEP);
    assert_ok(labial_beside_restart(&player, 16000));
    for (unsigned k = 0; k < EASE; k++) {
        assert_int_equal(labial_beside_tick(&player, 0, values), LABIAL_STARVED);
        assert_int_equal(memcmp(values, at_rest, OUTPUTS) == 0, k == EASE - 1);
    }
    assert_ok(feed(0, 10, 0)); /* of the same session, by chance */
    assert_shows(320, 1);
}

/* Catches changes in units that are rounded to more than the servo bears. */
TEST(changes_have_units)
{
    assert_int_equal(LABIAL_BESIDE_CHANGE(100, 1400, 1900), 51);
    assert_int_equal(LABIAL_BESIDE_CHANGE(99, 1900, 1400), 50);
    assert_int_equal(LABIAL_BESIDE_CHANGE(60, 1400, 1900), 30);
    assert_int_equal(LABIAL_BESIDE_CHANGE(1, 1400, 1900), 1);
    assert_int_equal(LABIAL_BESIDE_CHANGE(500, 1400, 1900), 255);
    assert_int_equal(LABIAL_BESIDE_CHANGE(8000000, 4000000, -4000000), 255);
    assert_int_equal(LABIAL_BESIDE_CHANGE(7999999, 4000000, -4000000), 254);
    static uint8_t constant[LABIAL_BESIDE_CHANGE(4, 0, 255)];
    assert_int_equal(sizeof constant, 4);
}

/* Catches bytes that are another value than baked motion's. */
TEST(bytes_have_units)
{
    for (unsigned i = 0; i < 20000; i++) {
        const int32_t low = (int32_t)below(8000000) - 4000000,
                      high = low + (int32_t)below(8000001) - (int32_t)below(2) * 8000000;
        const uint8_t byte = (uint8_t)below(256);
        const double exact = low + ((double)high - low) * byte / 255;
        if (high - low >= -8000000)
            assert_true(fabs(labial_beside_value(byte, low, high) - exact) <= .5);
    }
    assert_int_equal(labial_beside_value(0, 1900, 1400), 1900);
    assert_int_equal(labial_beside_value(255, 1900, 1400), 1400);
    assert_int_equal(labial_beside_value(255, -4000000, 4000000), 4000000);
}

/* ---- A player that is plain -------------------------------------------------------------------------------------- */

enum { ALL = 20000 };

static struct {
    uint8_t marks[ALL]; /* 1 waits, 2 shown */
    int64_t now;
    unsigned quiet;
    int left; /* calls in which it comes to rest */
    uint8_t pose[OUTPUTS], goal[OUTPUTS], limits[OUTPUTS];
} plain;

static void plain_feed(int cancels, unsigned count, int64_t first)
{
    if (cancels) {
        memset(plain.marks, 0, sizeof plain.marks);
        plain.quiet = plain.quiet < HOLD ? HOLD : plain.quiet;
        plain.now = first > plain.now ? first : plain.now;
    }
    for (int64_t k = first; k < first + count; k++)
        if (k >= plain.now && k < plain.now + ROOM && !plain.marks[k])
            plain.marks[k] = 1;
}

static int plain_at(int64_t sample, int64_t rate, uint8_t values[OUTPUTS])
{
    const int64_t frame = sample * 50 / rate;
    if (frame <= plain.now - ROOM)
        memset(plain.marks, 0, sizeof plain.marks);
    if (frame > plain.now || frame <= plain.now - ROOM)
        plain.now = frame;
    if (frame == plain.now && plain.marks[frame] == 1) {
        plain.marks[frame] = 2;
        plain.quiet = 0;
        plain.left = EASE;
        for (unsigned i = 0; i < OUTPUTS; i++)
            plain.goal[i] = value_of((uint64_t)frame, i);
    } else {
        plain.quiet++;
    }
    for (unsigned i = 0; i < OUTPUTS; i++) {
        const int most = plain.limits[i];
        int move = plain.goal[i] - plain.pose[i];
        if (plain.quiet > HOLD)
            move = (at_rest[i] - plain.pose[i]) / (plain.left > 1 ? plain.left : 1);
        plain.pose[i] = (uint8_t)(plain.pose[i] + (move > most ? most : move < -most ? -most : move));
    }
    if (plain.quiet > HOLD)
        plain.left--;
    memcpy(values, plain.pose, OUTPUTS);
    return plain.quiet <= HOLD ? LABIAL_OK : LABIAL_STARVED;
}

/* Catches any other difference, with packets and clocks of all kinds. */
TEST_AFTER(begin, random_packets_and_clocks)
{
    for (unsigned round = 0; round < 60; round++) {
        const int64_t rate = 8000 + 4000 * below(10) + below(2) * 1025;
        int64_t sample = 0, sent = 0, end;
        const unsigned loses = below(30);
        assert_int_equal(labial_beside_init(&player, OUTPUTS, (uint32_t)rate, memory, sizeof memory), 0);
        memset(&plain, 0, sizeof plain);
        plain.quiet = HOLD;
        memcpy(plain.pose, at_rest, OUTPUTS);
        for (unsigned i = 0; i < OUTPUTS; i++) {
            plain.limits[i] = (uint8_t)(1 + below(255));
            assert_int_equal(labial_beside_limit(&player, i, plain.limits[i]), 0);
        }
        assert_int_equal(feed(0, 0, 0), 0);
        for (unsigned step = 0; step < 1500; step++) {
            uint8_t values[OUTPUTS], wanted[OUTPUTS];
            const int64_t heard = sample * 50 / rate;
            while (sent < heard + 40) {
                const unsigned count = 1 + below(20), repeat = below(3) ? 0 : below(20);
                const int64_t first = sent > repeat ? sent - repeat : 0;
                sent += count;
                if (below(100) < loses)
                    continue;
                end = sent - first;
                plain_feed(0, (unsigned)end, first);
                assert_int_equal(feed(0, (unsigned)end, (uint64_t)first), 0);
            }
            if (!below(400)) {
                plain_feed(1, 0, sent);
                assert_int_equal(feed(1, 0, (uint64_t)sent), LABIAL_CANCELLED);
                if (below(2))
                    sample = sent * rate / 50; /* what it had is dropped */
            }
            if (!below(200)) { /* by the player itself */
                const uint32_t frames = below(3) ? below(20) : LABIAL_CANCEL_MAX + below(2);
                plain_feed(1, 0, 0);
                plain.left = frames > LABIAL_CANCEL_MAX ? (int)LABIAL_CANCEL_MAX : (int)frames;
                assert_ok(labial_beside_cancel(&player, frames > 0 ? frames * 20 - below(20) : 0));
            }
            const int result = plain_at(sample, rate, wanted);
            assert_int_equal(labial_beside_tick(&player, (uint32_t)sample, values), result);
            assert_memory_equal(values, wanted, OUTPUTS);
            switch (below(40)) {
            case 0:
                break; /* stands still */
            case 1:
                sample -= sample < rate / 10 ? 0 : below((uint32_t)rate / 10);
                break;
            case 2:
                sample += below((uint32_t)rate);
                break;
            case 3:
                if (!below(20) && sample > rate * 3) {
                    sample -= rate * 2; /* a new beginning */
                    sent = sample * 50 / rate;
                }
                break;
            default:
                sample += rate / 50 + below(200) - 100;
                break;
            }
            if (sample < 0)
                sample = 0;
        }
        assert_true(sent < ALL - 300);
    }
}

SUITE(NULL, NULL)
