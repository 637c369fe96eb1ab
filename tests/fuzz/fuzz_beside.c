/*
 * fuzz_beside.c - any bytes as packets, as sample numbers and as calls in any order (labial/beside.h): nothing is read
 * beside a packet or written beside the player's memory, no value changes by more than its limit, the face comes to rest,
 * and a good packet is always accepted. The first two bytes are the outputs and the frames of memory; each call begins
 * with a byte that names it.
 */
#include "fuzz.h"
#include "labial/beside.h"

enum { FEED, FEED_MENDED, AT, CANCEL };

static void feed(labial_beside_t *player, const uint8_t *data, size_t size, unsigned outputs, int mends)
{
    uint8_t *packet = (uint8_t *)copy_of(data, size);
    int result, cancels = 0;
    if (mends && size >= LABIAL_BESIDE_HEAD + outputs) {
        const size_t frames = size / outputs;
        packet[0] = LABIAL_BESIDE_FORMAT;
        cancels = packet[1] &= 1u;
        packet[2] = (uint8_t)outputs;
        packet[3] = (uint8_t)((size - LABIAL_BESIDE_HEAD) / outputs - 1u);
        REQUIRE(frames > 0);
        size = LABIAL_BESIDE_HEAD + (packet[3] + 1u) * outputs;
        result = labial_beside_push(player, packet, size);
        REQUIRE((result == (cancels ? LABIAL_CANCELLED : LABIAL_OK) || result == LABIAL_NEW_SESSION) && player->known);
    } else {
        result = labial_beside_push(player, packet, size);
        REQUIRE(result == LABIAL_ERROR_PACKET || (result >= LABIAL_OK && result <= LABIAL_NEW_SESSION));
    }
    free(packet);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    input_t input = { data, size };
    const unsigned some = number(&input, 1), outputs = some ? some : 1u;
    const unsigned room = number(&input, 1), frames = room ? room : 1u;
    const uint32_t rate = 1u + number(&input, 1) * 1009u, bytes = (uint32_t)LABIAL_BESIDE_SIZE(outputs, frames);
    labial_beside_t *player = (labial_beside_t *)memory_of(sizeof *player);
    uint8_t *memory = (uint8_t *)memory_of(bytes), *values = (uint8_t *)memory_of(outputs);
    uint8_t *last = (uint8_t *)memory_of(outputs);
    int moves = 0; /* `last` is known */
    memset(player, 0x5a, sizeof *player);
    REQUIRE(labial_beside_init(player, outputs, rate, memory, bytes) == 0);
    for (unsigned i = 0; i < outputs; i++)
        REQUIRE(labial_beside_limit(player, i, 1u + (rate + i * 37u) % 255u) == 0);
    while (input.left >= 5) {
        const unsigned first = number(&input, 1), call = first & 3u;
        if (call == AT) {
            const unsigned wait = player->quiet == LABIAL_BESIDE_HOLD + 1 ? player->left : 0;
            uint32_t sample;
            int result;
            take(&input, &sample, sizeof sample);
            memset(values, 0xa5, outputs);
            result = labial_beside_tick(player, sample, values);
            REQUIRE(result == (player->known ? result & LABIAL_STARVED : LABIAL_ERROR_STATE));
            REQUIRE(player->quiet <= LABIAL_BESIDE_HOLD + 1 && player->left >= 1 && player->left <= LABIAL_CANCEL_MAX);
            for (unsigned i = 0; i < outputs && player->known; i++) {
                const int most = 1 + (int)((rate + i * 37u) % 255u), moved = values[i] - last[i];
                REQUIRE(!moves || (moved <= most && moved >= -most));
                if (player->quiet == LABIAL_BESIDE_HOLD + 1 && wait == 1) {
                    const int left = memory[i] - values[i];
                    REQUIRE(left == 0 || !moves || moved == (left > 0 ? most : -most));
                }
            }
            moves = player->known > 0;
            if (moves)
                memcpy(last, values, outputs);
        } else if (call == CANCEL) {
            REQUIRE((first & 64u ? labial_beside_restart(player, rate)
                                 : labial_beside_cancel(player, first * first * 10u)) == LABIAL_OK);
        } else {
            const size_t low = number(&input, 1), wanted = low | (number(&input, 1) & 3u) << 8;
            const size_t taken = wanted < input.left ? wanted : input.left;
            feed(player, input.at, taken, outputs, call == FEED_MENDED);
            input.at += taken;
            input.left -= taken;
        }
    }
    free(last);
    free(values);
    free(memory);
    free(player);
    return 0;
}
