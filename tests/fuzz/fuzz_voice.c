/*
 * fuzz_voice.c - any messages, utterances, clocks and cancels of a voice that is followed (labial/voice.h). The first
 * byte is the number of its places; each call begins with a byte that says which one it is.
 */
#include "fuzz.h"

#include "labial/voice.h"
#include "speech_en.h"
#include "words_en.h"

enum { ITEMS = 16, PLACES = 64 };

static unsigned byte(input_t *input)
{
    return number(input, 1);
}

/* A time: short ones, and those that are beyond everything. */
static uint64_t some_time(input_t *input)
{
    const unsigned scale = byte(input), value = byte(input);
    return scale < 248u ? (scale << 8 | value) * UINT64_C(2500) : UINT64_MAX >> (value & 63u);
}

static const labial_words_own_t *no_words(void *user, const char *text, size_t size)
{
    REQUIRE(user && (size == 0 || text[size - 1u] == text[size - 1u]));
    return NULL;
}

/* A message; each text lies at the end of its memory. */
static void tell(labial_voice_t *voice, input_t *input)
{
    labial_voice_item_t items[ITEMS];
    char *texts[ITEMS];
    labial_voice_message_t message;
    const unsigned kinds = byte(input), count = byte(input);
    labial_voice_counts_t before = labial_voice_counts(voice), after;
    int result;
    memset(&message, 0, sizeof message);
    message.items = items;
    message.count = count % (ITEMS + 1u);
    message.kind = (uint8_t)(kinds % 6u);
    message.times = (uint8_t)(kinds / 6u % 4u);
    message.utterance = kinds >> 5;
    message.key = count >> 6;
    message.gap = (uint16_t)(count >> 4);
    for (uint32_t i = 0; i < message.count; i++) {
        const unsigned size = byte(input);
        items[i].start = some_time(input);
        items[i].end = byte(input) & 1u ? items[i].start + byte(input) * UINT64_C(3000) : some_time(input);
        items[i].phoneme = (uint8_t)size;
        items[i].size = (uint16_t)(size < 128u ? size % 9u : size * 3u);
        texts[i] = (char *)memory_of(items[i].size);
        for (unsigned k = 0; k < items[i].size; k++)
            texts[i][k] = (char)(input->left > 0 ? byte(input) : 'a' + k % 26u);
        items[i].text = size == 255u ? NULL : texts[i];
    }
    result = labial_voice_tell(voice, &message);
    after = labial_voice_counts(voice);
    REQUIRE((result == LABIAL_ERROR_RANGE) ==
            (message.kind > LABIAL_VOICE_CHARACTERS || message.times > LABIAL_VOICE_JOINED));
    REQUIRE(result == LABIAL_OK || result == LABIAL_CANCELLED || result == LABIAL_ERROR_RANGE ||
            result == LABIAL_ERROR_FULL);
    REQUIRE(after.told + after.skipped <= before.told + before.skipped + message.count);
    for (uint32_t i = 0; i < message.count; i++)
        free(texts[i]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static labial_voice_t voice;
    input_t input = { data, size };
    const uint32_t bytes = LABIAL_VOICE_SIZE(3, 8, 1u + byte(&input) % PLACES);
    uint32_t *const memory = (uint32_t *)memory_of(bytes);
    uint64_t clock = 0;
    uint32_t frames = 0;
    REQUIRE(labial_voice_init(&voice, &speech_en, memory, bytes) == LABIAL_OK);
    REQUIRE(labial_voice_words(&voice, &words_en, NULL) == LABIAL_OK);
    while (input.left > 0 && frames < 400u) {
        const unsigned call = byte(&input);
        int16_t faps[LABIAL_CHANNELS];
        uint32_t frame, last = 0;
        switch (call % 8u) {
        default:
            tell(&voice, &input);
            break;
        case 0:
            clock += byte(&input) * 10u;
            while (labial_voice_next(&voice, clock, &frame, faps) == LABIAL_OK) {
                REQUIRE(frame <= clock / 20u && (last == 0 || frame == last + 1u));
                last = frame;
                frames++;
            }
            break;
        case 1:
            clock = call < 32u    ? clock + byte(&input) * 40u
                    : call < 250u ? clock / 2u
                                  : LABIAL_VOICE_CLOCK - byte(&input);
            break;
        case 2:
            (void)labial_voice_begin(&voice, call < 128u ? LABIAL_VOICE_BEHIND : clock + byte(&input) * 10u, call >> 5);
            break;
        case 3:
            if (call < 16u)
                (void)labial_voice_ease(&voice, faps);
            else if (call < 64u)
                REQUIRE(labial_voice_cancel(&voice, byte(&input) * 8u) == LABIAL_OK);
            else if (call < 128u)
                REQUIRE(labial_voice_finish(&voice) == LABIAL_OK);
            else if (call < 160u)
                REQUIRE(labial_voice_offset(&voice, (int32_t)byte(&input) * 4 - 512) == LABIAL_OK);
            else
                REQUIRE(labial_voice_pronounce(&voice, call < 200u ? no_words : NULL, &voice) == LABIAL_OK);
            REQUIRE(labial_voice_done(&voice) <= 1);
        }
    }
    free(memory);
    return 0;
}
