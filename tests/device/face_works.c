/*
 * face_works.c - how a board moves a face: frames, values, gaps, bursts, cancels and a clock, drawn from a seed, and the
 * CRC-32 of every value. Passes if it is that of the face in tests/python/test_face.py, which is written anew there.
 */
#include "board.h"
#include "checksum.h"

#include "labial/face.h"

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
static uint32_t seed = 1, crc = CHECKSUM_BEGIN;

static uint32_t draw(uint32_t below)
{
    return checksum_draw(&seed, below);
}

static void add(uint32_t byte)
{
    crc = checksum_add(crc, byte);
}

static void give(void)
{
    unsigned i;
    if (draw(4)) {
        int16_t faps[LABIAL_CHANNELS];
        const uint32_t touches = draw(3);
        for (i = 0; i < LABIAL_CHANNELS; i++)
            faps[i] = (int16_t)((int32_t)draw(301) - 150);
        faps[4] = (int16_t)(touches ? faps[4] - 300 : 0);
        labial_face_frame(&face, 0, faps);
    } else {
        int32_t wanted[OUTPUTS];
        for (i = 0; i < OUTPUTS; i++)
            wanted[i] = 5000 + (int32_t)draw(3001);
        labial_face_values(&face, wanted);
    }
}

int main(void)
{
    int32_t values[OUTPUTS];
    uint32_t now = 0xffffc000u, i, k;
    labial_face_init(&face, &rig, 50, AHEAD, memory, sizeof memory);
    labial_face_soft_start(&face, 10);
    for (i = 0; i < CALLS; i++) {
        const uint32_t what = draw(60);
        if (what == 0)
            labial_face_cancel(&face, 181);
        for (k = what == 1 ? draw(12) : what == 2 || i % 250u > 200u ? 0 : 1; k > 0; k--)
            give();
        now += 15u + draw(11) + (what == 3 ? draw(200) : 0);
        while (labial_face_due(&face, now)) {
            add((uint32_t)labial_face_tick(&face, values));
            for (k = 0; k < OUTPUTS; k++) {
                add((uint32_t)values[k]);
                add((uint32_t)values[k] >> 8);
            }
            add(labial_face_attached(&face));
        }
    }
    if (~crc != MOVED) {
        board_print_unsigned(~crc);
        board_print(": FAILED\n");
    }
    return ~crc != MOVED;
}
