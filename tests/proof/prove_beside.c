/* Any packets, sample numbers and cancels, in any order, in players of several sizes. A packet is in memory as long as
 * the longest of its outputs, since the prover does not relate its size to the count in its head. */
#include "labial/beside.h"

#include "prove.h"

static uint8_t memory[LABIAL_BESIDE_SIZE(6u, 20u)], values[6];
static uint8_t packet[LABIAL_BESIDE_HEAD + 6u * 256u];

static void play(unsigned outputs, uint32_t size)
{
    labial_beside_t player;
    if (labial_beside_init(OR_NULL(labial_beside_t *, &player), outputs, any_uint32, OR_NULL(void *, memory), size) !=
        LABIAL_OK)
        return;
    while (any_int) {
        if (any_int) {
            FILL(packet);
            labial_beside_push(OR_NULL(labial_beside_t *, &player), OR_NULL(const void *, packet), any_size);
        }
        if (any_int)
            labial_beside_tick(OR_NULL(labial_beside_t *, &player), any_uint32, OR_NULL(uint8_t *, values));
        if (any_int)
            labial_beside_limit(OR_NULL(labial_beside_t *, &player), any_unsigned, any_unsigned);
        if (any_int)
            labial_beside_restart(OR_NULL(labial_beside_t *, &player), any_uint32);
        if (any_int)
            labial_beside_cancel(OR_NULL(labial_beside_t *, &player), any_uint32);
    }
}

int main(void)
{
    static const labial_beside_t unprepared;
    labial_beside_t player = unprepared;
    labial_beside_push(&player, packet, any_size);
    labial_beside_tick(&player, any_uint32, values);
    labial_beside_cancel(&player, any_uint32);
    labial_beside_limit(&player, any_unsigned, any_unsigned);
    labial_beside_restart(&player, any_uint32);
    labial_beside_init(&player, any_unsigned, any_uint32, memory, 4);
    play(0, sizeof memory);
    play(1, 6);
    play(1, LABIAL_BESIDE_SIZE(1, 64));
    play(3, LABIAL_BESIDE_SIZE(3, 17));
    play(6, sizeof memory);
    labial_beside_value(any_uint8, any_int16, any_int16);
    return 0;
}
