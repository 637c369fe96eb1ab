/*
 * beside_works.c - what a board shows of lips that come beside their sound: packets and clocks of all kinds, drawn from
 * a seed, and the CRC-32 of what is shown. Passes if it is that of the player in tests/python/test_beside.py.
 */
#include "board.h"
#include "checksum.h"

#include "labial/beside.h"

#define OUTPUTS 2u
#define FRAMES 32u
#define CALLS 3000u
#define SHOWN 0x6145dfcdu

static labial_beside_t player;
static uint8_t memory[LABIAL_BESIDE_SIZE(OUTPUTS, FRAMES)];
static uint32_t seed = 1, crc = CHECKSUM_BEGIN;

static uint32_t draw(uint32_t below)
{
    return checksum_draw(&seed, below);
}

static void add(uint32_t number)
{
    crc = checksum_add(crc, number);
}

/* A packet of frames around one, of which few cancel. */
static void feed(uint32_t frame)
{
    uint8_t packet[LABIAL_BESIDE_HEAD + OUTPUTS * 17u];
    static uint32_t session;
    uint32_t first = frame + draw(40), size = 0, frames, k;
    first -= first < 8u ? first : 8u;
    packet[size++] = LABIAL_BESIDE_FORMAT;
    packet[size++] = draw(20) == 0;
    packet[size++] = OUTPUTS;
    frames = draw(17);
    packet[size++] = (uint8_t)frames;
    for (k = 0; k < 4; k++)
        packet[size++] = (uint8_t)(first >> 8 * k);
    session += draw(60) == 0;
    packet[size++] = (uint8_t)session;
    packet[size++] = 0x5a;
    for (k = 0; k < OUTPUTS * (frames + 1u); k++)
        packet[size++] = (uint8_t)draw(256);
    add((uint32_t)labial_beside_push(&player, packet, size));
}

int main(void)
{
    static const uint32_t rates[] = { 8000, 11025, 48000 };
    uint32_t i, k, sample, frame;
    uint8_t values[OUTPUTS];
    for (i = 0; i < 3; i++) {
        labial_beside_init(&player, OUTPUTS, rates[i], memory, sizeof memory);
        labial_beside_limit(&player, 0, 100);
        labial_beside_limit(&player, 1, 255);
        sample = frame = 0;
        for (k = 0; k < CALLS; k++) {
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
    if (~crc != SHOWN) {
        board_print_unsigned(~crc);
        board_print(": FAILED\n");
    }
    return ~crc != SHOWN;
}
