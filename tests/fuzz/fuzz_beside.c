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
    labial_beside_t *player = (labial_beside_t *)memory_of(sizeof *player);
    unsigned outputs, frames;
    uint32_t sample = 0, rate;
    uint8_t *memory, *values, *last;
    int moves = 0; /* `last` is known */
    outputs = size > 2 && data[0] ? data[0] : 1u;
    frames = size > 2 && data[1] ? data[1] : 1u;
    rate = size > 2 ? 1u + data[2] * 1009u : 1u;
    memory = (uint8_t *)memory_of(LABIAL_BESIDE_SIZE(outputs, frames));
    values = (uint8_t *)memory_of(outputs);
    last = (uint8_t *)memory_of(outputs);
    memset(player, 0x5a, sizeof *player);
    REQUIRE(labial_beside_init(player, outputs, rate, memory, LABIAL_BESIDE_SIZE(outputs, frames)) == 0);
    for (frames = 0; frames < outputs; frames++)
        REQUIRE(labial_beside_limit(player, frames, 1u + (rate + frames * 37u) % 255u) == 0);
    data += size > 2 ? 3 : size;
    size -= size > 2 ? 3 : size;
    while (size >= 5) {
        const unsigned call = data[0] & 3u;
        if (call == AT) {
            const unsigned wait = player->quiet == LABIAL_BESIDE_HOLD + 1 ? player->left : 0;
            int result;
            memcpy(&sample, data + 1, sizeof sample);
            memset(values, 0xa5, outputs);
            result = labial_beside_tick(player, sample, values);
            REQUIRE(result == (player->known ? result & LABIAL_STARVED : LABIAL_ERROR_STATE));
            REQUIRE(player->quiet <= LABIAL_BESIDE_HOLD + 1 && player->left >= 1 && player->left <= LABIAL_CANCEL_MAX);
            for (frames = 0; frames < outputs && player->known; frames++) {
                const int most = 1 + (int)((rate + frames * 37u) % 255u), moved = values[frames] - last[frames];
                REQUIRE(!moves || (moved <= most && moved >= -most));
                if (player->quiet == LABIAL_BESIDE_HOLD + 1 && wait == 1) {
                    const int left = memory[frames] - values[frames];
                    REQUIRE(left == 0 || !moves || moved == (left > 0 ? most : -most));
                }
            }
            moves = player->known > 0;
            if (moves)
                memcpy(last, values, outputs);
            data += 5;
            size -= 5;
        } else if (call == CANCEL) {
            REQUIRE((data[0] & 64u ? labial_beside_restart(player, rate)
                                   : labial_beside_cancel(player, data[0] * data[0] * 10u)) == LABIAL_OK);
            data++;
            size--;
        } else {
            const size_t wanted = data[1] | (data[2] & 3u) << 8;
            const size_t taken = wanted < size - 3u ? wanted : size - 3u;
            feed(player, data + 3, taken, outputs, call == FEED_MENDED);
            data += 3 + taken;
            size -= 3 + taken;
        }
    }
    free(last);
    free(values);
    free(memory);
    free(player);
    return 0;
}
