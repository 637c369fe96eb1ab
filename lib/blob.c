/*
 * blob.c - a model laid over bytes from a file or a flash page (labial/blob.h).
 */
#include "labial/blob.h"

#include <string.h>

#include "fixed.h"
#include "labial/labial.h"

#define HEADER_SIZE 48u
#define CHECKED_FROM 12u /* first byte that the checksum covers */

enum { HAS_CONTEXTS = 1, HAS_SLOPES = 2, HAS_TWO_KNOTS = 4, HAS_PROTRUSION = 8 };

typedef char labial_tables_are_packed[sizeof(labial_phoneme_t) == 6 && sizeof(labial_component_t) == 6 &&
                                              sizeof(labial_emission_t) == 4 && sizeof(labial_state_t) == 8 &&
                                              sizeof(labial_protrusion_t) == 4 + 2 * LABIAL_PROTRUSION_VALUES
                                          ? 1
                                          : -1];

/* Where the reading stands. `damaged` is set when a table would end beyond the data. */
typedef struct {
    const uint8_t *data;
    size_t size, at;
    int damaged;
} reader_t;

static uint16_t u16(const uint8_t *at)
{
    return (uint16_t)(at[0] | at[1] << 8);
}

static uint32_t u32(const uint8_t *at)
{
    return u16(at) | (uint32_t)u16(at + 2) << 16;
}

/* CRC-32, polynomial 0xedb88320, bit by bit: run once per model, so small before fast. */
static uint32_t checksum(const uint8_t *at, size_t size)
{
    uint32_t crc = UINT32_MAX;
    size_t i;
    unsigned bit;
    for (i = 0; i < size; i++) {
        crc ^= at[i];
        for (bit = 0; bit < 8; bit++)
            crc = (crc >> 1) ^ ((crc & 1u) ? 0xedb88320u : 0u);
    }
    return ~crc;
}

static int is_little_endian(void)
{
    const uint16_t one = 1;
    return *(const uint8_t *)(const void *)&one;
}

/* The next table of `count` elements of `size` bytes, and the padding behind it. Counts and sizes come from 8- and
 * 16-bit fields, so that their product does not overflow. */
static const void *table(reader_t *reader, uint32_t count, uint32_t size)
{
    const uint8_t *start = reader->data + reader->at;
    const uint32_t padded = (count * size + 3u) / 4u * 4u;
    if (reader->damaged || padded > reader->size - reader->at) {
        reader->damaged = 1;
        return NULL;
    }
    reader->at += padded;
    /* What was left holds the table. */
    /*@ assert reader->at <= reader->size; */
    /*@ assert start <= reader->data + (reader->size - padded); */
    LABIAL_CHECK(reader->at <= reader->size && start + padded == reader->data + reader->at);
    return start;
}

static void read_channel(reader_t *reader, uint32_t states, uint32_t transitions, labial_channel_t *channel)
{
    const uint8_t *scales = (const uint8_t *)table(reader, 8u, 2u);
    if (!scales)
        return;
    channel->centre = (int16_t)u16(scales);
    channel->shape_scale = u16(scales + 2);
    channel->slope_scale = u16(scales + 4);
    channel->kernel_scale = u16(scales + 6);
    channel->pair_scale = u16(scales + 8);
    channel->motion_scale[0] = u16(scales + 10);
    channel->motion_scale[1] = u16(scales + 12);
    channel->contact_weight = scales[14];
    channel->emissions = (const labial_emission_t *)table(reader, states, sizeof(labial_emission_t));
    channel->states = (const labial_state_t *)table(reader, states, sizeof(labial_state_t));
    channel->transitions = (const labial_transition_t *)table(reader, transitions, sizeof(labial_transition_t));
    channel->initials = (const uint8_t *)table(reader, states, 1u);
}

static void read_tables(reader_t *reader, unsigned optional, labial_model_t *model, labial_channel_t *channels)
{
    const uint32_t width = model->channel_count;
    const uint32_t components = model->component_count, shape = components * width;
    const uint32_t rows = (uint32_t)model->phoneme_count * model->kernel_taps;
    unsigned k;
    model->phonemes = (const labial_phoneme_t *)table(reader, model->phoneme_count, sizeof(labial_phoneme_t));
    model->components = (const labial_component_t *)table(reader, components, sizeof(labial_component_t));
    if (optional & HAS_CONTEXTS)
        model->contexts = (const uint8_t *)table(reader, components, model->class_count);
    model->shapes = (const int8_t *)table(reader, shape, 1u);
    if (optional & HAS_SLOPES)
        model->slopes = (const int8_t *)table(reader, shape, 1u);
    if (model->kernel_taps)
        model->kernels = (const uint32_t *)table(reader, rows, 4u * LABIAL_KERNEL_WORDS(width));
    if (model->pair_count) {
        model->pair_keys = (const uint16_t *)table(reader, model->pair_count, 2u);
        model->pairs = (const int8_t *)table(reader, (uint32_t)model->pair_count * model->pair_knots * width, 1u);
    }
    if (model->floor_count) {
        model->floors = (const int16_t *)table(reader, (uint32_t)model->floor_count * width, 2u);
        model->contacts = (const uint16_t *)table(reader, model->floor_count, 2u);
    }
    if (optional & HAS_PROTRUSION)
        model->protrusion = (const labial_protrusion_t *)table(reader, 1u, sizeof(labial_protrusion_t));
    for (k = 0; k < width; k++)
        read_channel(reader, model->state_count, 4u * model->state_count * model->predecessor_fours, &channels[k]);
    model->channels = channels;
}

int labial_model_load(labial_blob_t *blob, const void *data, size_t size)
{
    const uint8_t *header = (const uint8_t *)data;
    labial_model_t *model;
    reader_t reader;
    int result;

    if (!blob || !data)
        return LABIAL_ERROR_NULL;
    if (!is_little_endian()) /* GCOVR_EXCL_BR_LINE: on the machines of the coverage it always is */
        return LABIAL_ERROR_VERSION;
    if (((uintptr_t)data & 3u) || size < HEADER_SIZE || header[0] != 'L' || header[1] != 'B' || header[2] != 'M' ||
        header[3] != '1' || u32(header + 4) != size)
        return LABIAL_ERROR_MODEL;
    if (u16(header + 12) != LABIAL_MODEL_FORMAT)
        return LABIAL_ERROR_VERSION;
    if (header[28] > (HAS_CONTEXTS | HAS_SLOPES | HAS_TWO_KNOTS | HAS_PROTRUSION) || header[32] > LABIAL_CHANNELS)
        return LABIAL_ERROR_MODEL;
    if (u32(header + 8) != checksum(header + CHECKED_FROM, size - CHECKED_FROM))
        return LABIAL_ERROR_MODEL;

    memset(blob, 0, sizeof *blob);
    model = &blob->model;
    model->format = LABIAL_MODEL_FORMAT;
    model->frames_per_second = u16(header + 14);
    model->component_count = u16(header + 16);
    model->phoneme_count = header[18];
    model->class_count = header[19];
    model->state_count = header[20];
    model->predecessor_fours = header[21];
    model->search_stride = header[22];
    model->silence = header[23];
    model->mixture_mean = header[24];
    model->kernel_taps = header[25];
    model->kernel_stride = header[26];
    model->kernel_behind = header[27];
    model->pair_knots = (header[28] & HAS_TWO_KNOTS) ? 2u : 1u;
    model->floor_count = header[29];
    model->pair_count = u16(header + 30);
    model->channel_count = header[32];
    memcpy(model->sources, header + 33, sizeof model->sources);
    reader.data = header;
    reader.size = size;
    reader.at = HEADER_SIZE;
    reader.damaged = 0;
    read_tables(&reader, header[28], model, blob->channels);
    if (reader.damaged || reader.at != size)
        return LABIAL_ERROR_MODEL;
    result = labial_model_check(model);
    return result == LABIAL_ERROR_NULL ? LABIAL_ERROR_MODEL : result; /* a table that the model needs is not there */
}
