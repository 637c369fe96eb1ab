/*
 * hearing_works.c - what a board hears: the frames of the exporter's integers for sounds of every rate and kind, by
 * their CRC-32, and the largest sums. Passes if all are right.
 */
#include "board.h"

#include "drawn.h"
#include "hear_fixture.h"
#include "hear_sums.h"
#include "hears.h"
#include "labial/hear.h"

#define BLOCK 48u

#if LABIAL_HEAR_SUMS

/* labial_hear_sums() as a program defines it, from the order of weights that labial/hear_model.h states; with
 * OWN_SUMS_WRONG from another order, which the tests below must notice. */
#ifdef OWN_SUMS_WRONG
#define WEIGHT(row, column) (4u * (column) + (row))
#else
#define WEIGHT(row, column) (8u * ((column) / 2u) + 4u * ((row) / 2u) + 2u * ((column) % 2u) + (row) % 2u)
#endif

void labial_hear_sums(const int8_t *weights, const int16_t *x, unsigned columns, int32_t sums[4])
{
    for (unsigned row = 0; row < 4u; row++) {
        sums[row] = 0;
        for (unsigned column = 0; column < columns; column++)
            sums[row] += weights[WEIGHT(row, column)] * x[column];
    }
}

#endif

static labial_hear_t hear;
static uint32_t workspace[HEAR_FIXTURE_WORKSPACE_SIZE / 4];
static uint32_t frames, crc;

static void add(uint8_t byte)
{
    crc = checksum_add(crc, byte);
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    frames = frame + 1u;
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
        add((uint8_t)((uint16_t)faps[k] & 255u));
        add((uint8_t)((uint16_t)faps[k] >> 8));
    }
}

/* Whether the sound in this row of the table gives its frames. */
static int is_heard(unsigned row)
{
    int16_t block[2u * BLOCK];
    uint32_t state = 1, used = 0;
    frames = 0;
    crc = CHECKSUM_BEGIN;
    if (labial_hear_init(&hear, &hear_fixture, hears[row].rate, hears[row].channels, workspace, sizeof workspace,
                         on_frame, NULL) != LABIAL_OK)
        return 0;
    for (uint32_t at = 0; at < hears[row].samples; at++) {
        const int32_t value = hear_sound(hears[row].sound, at, &state);
        block[used * hears[row].channels] = (int16_t)value;
        if (hears[row].channels == 2u)
            block[2u * used + 1u] = (int16_t) - (value >> 1);
        if (++used == BLOCK || at + 1u == hears[row].samples) {
            labial_hear_push(&hear, block, used);
            used = 0;
        }
    }
    return labial_hear_end(&hear) == LABIAL_OK && frames == hears[row].frames && ~crc == hears[row].faps_crc;
}

/* Whether the sums of the largest weights and activations are right, wherever the tables begin. */
static int sums_are_exact(void)
{
    static const int8_t ends[] = { 127, -127, 1, -1, 0 };
    static int8_t weights[4u * LABIAL_HEAR_UNITS_MAX + 1u];
    static int16_t x[LABIAL_HEAR_UNITS_MAX + 1u];
    for (unsigned round = 0; round < 200u; round++) {
        const unsigned columns = round < 50u ? LABIAL_HEAR_UNITS_MAX : 4u + 4u * (round % 32u), begin = round & 1u;
        int32_t sums[4], wanted[4] = { 0, 0, 0, 0 };
        for (unsigned i = 0; i < columns; i++) {
            x[begin + i] = (int16_t)(round % 3u == 0u ? -32768 : (i + round) % 7u == 0u ? -32768 : 32767);
            for (unsigned row = 0; row < 4u; row++) {
                const int8_t weight = ends[(round + row * (round / 5u) + i * (round / 25u)) % sizeof ends];
                weights[begin + 8u * (i / 2u) + 4u * (row / 2u) + 2u * (i % 2u) + row % 2u] = weight;
                wanted[row] += weight * x[begin + i];
            }
        }
        labial_hear_sums(weights + begin, x + begin, columns, sums);
        for (unsigned row = 0; row < 4u; row++)
            if (sums[row] != wanted[row])
                return 0;
    }
    return 1;
}

int main(void)
{
    unsigned wrong = 0;
    if (!sums_are_exact()) {
        board_print("sums: FAILED\n");
        wrong++;
    }
    for (unsigned row = 0; row < sizeof hears / sizeof hears[0]; row++)
        if (!is_heard(row)) {
            board_print_within("sound ", row, ": FAILED\n");
            wrong++;
        }
    return wrong > 0;
}
