/*
 * motion_works.c - what a board shows and moves, drawn from a seed, and its CRC-32. Passes if these are those of the
 * host, whose player tests/c/test_beside.c compares with a plain one, and those of the face that is written anew in
 * tests/python/test_face.py.
 */
#include "board.h"
#include "drawn.h"

#include "labial/beside.h"
#include "labial/face.h"

static uint32_t seed = 1, crc = CHECKSUM_BEGIN;

static uint32_t draw(uint32_t below)
{
    return drawn_below(&seed, below);
}

static void add(uint32_t byte)
{
    crc = checksum_add(crc, byte);
}

/* Whether what was added is what was expected; then begins anew. */
static int is(uint32_t expected)
{
    const uint32_t found = ~crc;
    seed = 1;
    crc = CHECKSUM_BEGIN;
    if (found != expected)
        board_print_within("", found, ": FAILED\n");
    return found == expected;
}

/* ---- Lips that come beside their sound: packets and clocks of all kinds ------------------------------------------ */

#define BYTES 2u
#define FRAMES 32u
#define PACKETS 3000u
#define SHOWN 0x6145dfcdu

static labial_beside_t player;
static uint8_t player_memory[LABIAL_BESIDE_SIZE(BYTES, FRAMES)];

/* A packet of frames around one, of which few cancel. */
static void feed(uint32_t frame)
{
    uint8_t packet[LABIAL_BESIDE_HEAD + BYTES * 17u];
    static uint32_t session;
    uint32_t first = frame + draw(40), size = 0, frames, k;
    first -= first < 8u ? first : 8u;
    packet[size++] = LABIAL_BESIDE_FORMAT;
    packet[size++] = draw(20) == 0;
    packet[size++] = BYTES;
    frames = draw(17);
    packet[size++] = (uint8_t)frames;
    for (k = 0; k < 4; k++)
        packet[size++] = (uint8_t)(first >> 8 * k);
    session += draw(60) == 0;
    packet[size++] = (uint8_t)session;
    packet[size++] = 0x5a;
    for (k = 0; k < BYTES * (frames + 1u); k++)
        packet[size++] = (uint8_t)draw(256);
    add((uint32_t)labial_beside_push(&player, packet, size));
}

static int beside(void)
{
    static const uint32_t rates[] = { 8000, 11025, 48000 };
    uint32_t sample, frame;
    uint8_t values[BYTES];
    for (uint32_t i = 0; i < 3; i++) {
        labial_beside_init(&player, BYTES, rates[i], player_memory, sizeof player_memory);
        labial_beside_limit(&player, 0, 100);
        labial_beside_limit(&player, 1, 255);
        sample = frame = 0;
        for (uint32_t k = 0; k < PACKETS; k++) {
            if (draw(4) == 0 || k == 0)
                feed(frame);
            add((uint32_t)labial_beside_tick(&player, sample, values));
            add(values[0]);
            add(values[1]);
            add((uint32_t)labial_beside_value(values[0], 1900, -1400) >> 4);
            if (draw(50) == 0) {
                sample += draw(3) * rates[i];
                frame += draw(100);
            } else if (draw(20) > 0) {
                sample += rates[i] / 50u + draw(64) - 32u;
                frame += 1u;
            }
        }
    }
    return is(SHOWN);
}

/* ---- A face: frames, values, gaps, bursts, cancels and a clock --------------------------------------------------- */

#define OUTPUTS 3u
#define AHEAD 6u
#define CALLS 1000u
#define MOVED 0x3ec3eb88u

/* A servo that looks ahead, one with a limit of acceleration, and one without limits, in units of a Maestro. */
static const labial_rig_output_t outputs[OUTPUTS] = {
    LABIAL_RIG_SERVO(5600, 7600, 240),
    { { 0, 0, 0, 0, -4096, 0, 0, 0, 0, 0, 0, 0, 0 }, 0, 1, 218453, 5600, 5600, 7600, 360, 5600, 0, 120, 0, NULL },
    { { 3277, 0, 0, 0, 0, 4096, 4096, 0, 0, 0, 0, 4096, 4096 }, 1, 0, 136533, 6000, 5200, 7120, 0, 0, 24, 0, 0, NULL },
};
static const labial_rig_t rig = { outputs, OUTPUTS };
static labial_face_t face;
static int32_t memory[LABIAL_FACE_SIZE(OUTPUTS, AHEAD) / 4];

static void give(void)
{
    if (draw(4)) {
        int16_t faps[LABIAL_CHANNELS];
        const uint32_t touches = draw(3);
        for (unsigned i = 0; i < LABIAL_CHANNELS; i++)
            faps[i] = (int16_t)((int32_t)draw(301) - 150);
        faps[4] = (int16_t)(touches ? faps[4] - 300 : 0);
        labial_face_frame(&face, 0, faps);
    } else {
        int32_t wanted[OUTPUTS];
        for (unsigned i = 0; i < OUTPUTS; i++)
            wanted[i] = 5000 + (int32_t)draw(3001);
        labial_face_values(&face, wanted);
    }
}

static int face_moves(void)
{
    int32_t values[OUTPUTS];
    uint32_t now = 0xffffc000u;
    labial_face_init(&face, &rig, 50, AHEAD, memory, sizeof memory);
    labial_face_soft_start(&face, 10);
    for (uint32_t i = 0; i < CALLS; i++) {
        const uint32_t what = draw(60);
        if (what == 0)
            labial_face_cancel(&face, 181);
        for (uint32_t k = what == 1 ? draw(12) : what == 2 || i % 250u > 200u ? 0 : 1; k > 0; k--)
            give();
        now += 15u + draw(11) + (what == 3 ? draw(200) : 0);
        while (labial_face_due(&face, now)) {
            add((uint32_t)labial_face_tick(&face, values));
            for (uint32_t k = 0; k < OUTPUTS; k++) {
                add((uint32_t)values[k]);
                add((uint32_t)values[k] >> 8);
            }
            add(labial_face_attached(&face));
        }
    }
    return is(MOVED);
}

int main(void)
{
    const int shows = beside(), moves = face_moves();
    return !(shows && moves);
}
