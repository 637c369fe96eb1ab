/*
 * fixture_blob.c - models as blobs, written from the description in labial/blob.h alone.
 */
#include "fixture.h"

uint32_t fixture_crc32(const uint8_t *data, size_t size)
{
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1u ? (crc >> 1) ^ 0xedb88320u : crc >> 1;
    }
    return crc ^ 0xffffffffu;
}

/* Output that counts beyond its end and then writes nothing more. */
typedef struct {
    uint8_t *out;
    size_t size, room;
} writer_t;

static void put(writer_t *w, uint32_t value, unsigned bytes)
{
    for (; bytes; bytes--, value >>= 8, w->size++)
        if (w->size < w->room)
            w->out[w->size] = (uint8_t)value;
}

static void put_bytes(writer_t *w, const void *table, size_t bytes)
{
    const uint8_t *from = (const uint8_t *)table;
    for (size_t i = 0; from && i < bytes; i++)
        put(w, from[i], 1);
}

static void pad(writer_t *w)
{
    while (w->size % 4u)
        put(w, 0, 1);
}

static void put_channel(writer_t *w, const labial_channel_t *channel, unsigned states, unsigned transitions)
{
    const uint16_t head[] = { (uint16_t)channel->centre, channel->shape_scale, channel->slope_scale,
                              channel->kernel_scale,     channel->pair_scale,  channel->motion_scale[0],
                              channel->motion_scale[1] };
    for (unsigned i = 0; i < sizeof head / sizeof *head; i++)
        put(w, head[i], 2);
    put(w, channel->contact_weight, 1);
    put(w, 0, 1);
    for (unsigned q = 0; q < states; q++) {
        put(w, (uint16_t)channel->emissions[q].mean, 2);
        put(w, channel->emissions[q].gain, 1);
        put(w, channel->emissions[q].cost, 1);
    }
    pad(w);
    for (unsigned q = 0; q < states; q++) {
        put(w, (uint16_t)channel->states[q].mean, 2);
        put_bytes(w, channel->states[q].motion, 2);
        put(w, channel->states[q].hold, 1);
        put(w, channel->states[q].share, 1);
        put_bytes(w, channel->states[q].weight, 2);
    }
    pad(w);
    for (unsigned i = 0; i < transitions; i++) {
        put(w, channel->transitions[i].predecessor, 1);
        put(w, channel->transitions[i].cost, 1);
    }
    pad(w);
    put_bytes(w, channel->initials, states);
    pad(w);
}

size_t fixture_serialise(const labial_model_t *model, uint8_t *out, size_t room)
{
    const size_t n = model->component_count, channels = model->channel_count;
    writer_t w = { out, 0, room };
    put_bytes(&w, "LBM1", 4);
    put(&w, 0, 4);
    put(&w, 0, 4);
    put(&w, model->format, 2);
    put(&w, model->frames_per_second, 2);
    put(&w, model->component_count, 2);
    const uint8_t counts[] = { model->phoneme_count, model->class_count,  model->state_count,  model->predecessor_fours,
                               model->search_stride, model->silence,      model->mixture_mean, model->kernel_taps,
                               model->kernel_stride, model->kernel_behind };
    put_bytes(&w, counts, sizeof counts);
    put(&w,
        (model->contexts ? 1u : 0u) | (model->slopes ? 2u : 0u) | (model->pair_knots == 2 ? 4u : 0u) |
            (model->protrusion ? 8u : 0u),
        1);
    put(&w, model->floor_count, 1);
    put(&w, model->pair_count, 2);
    put(&w, model->channel_count, 1);
    put_bytes(&w, model->sources, LABIAL_CHANNELS);
    put(&w, 0, 2);
    for (unsigned i = 0; i < model->phoneme_count; i++) {
        put(&w, model->phonemes[i].first_component, 2);
        put(&w, model->phonemes[i].component_count, 1);
        put(&w, model->phonemes[i].viseme_class, 1);
        put(&w, model->phonemes[i].boundary, 1);
        put(&w, model->phonemes[i].floor, 1);
    }
    pad(&w);
    for (unsigned i = 0; i < n; i++) {
        put(&w, model->components[i].cost, 2);
        put(&w, model->components[i].duration_mean, 2);
        put(&w, model->components[i].duration_gain, 2);
    }
    pad(&w);
    put_bytes(&w, model->contexts, n * model->class_count);
    pad(&w);
    put_bytes(&w, model->shapes, n * channels);
    pad(&w);
    put_bytes(&w, model->slopes, n * channels);
    pad(&w);
    for (size_t i = 0; i < LABIAL_KERNEL_WORDS(channels) * model->phoneme_count * model->kernel_taps; i++)
        put(&w, model->kernels[i], 4);
    for (unsigned i = 0; i < model->pair_count; i++)
        put(&w, model->pair_keys[i], 2);
    pad(&w);
    put_bytes(&w, model->pairs, (size_t)model->pair_count * model->pair_knots * channels);
    pad(&w);
    for (unsigned i = 0; i < (unsigned)model->floor_count * channels; i++)
        put(&w, (uint16_t)model->floors[i], 2);
    pad(&w);
    for (unsigned i = 0; i < model->floor_count; i++)
        put(&w, model->contacts[i], 2);
    pad(&w);
    if (model->protrusion) {
        put(&w, (uint16_t)model->protrusion->low, 2);
        put(&w, model->protrusion->gain, 2);
        for (unsigned i = 0; i < LABIAL_PROTRUSION_VALUES; i++)
            put(&w, (uint16_t)model->protrusion->values[i], 2);
        pad(&w);
    }
    for (unsigned i = 0; i < channels; i++)
        put_channel(&w, &model->channels[i], model->state_count, 4u * model->state_count * model->predecessor_fours);
    if (w.size <= room)
        fixture_seal(out, w.size);
    return w.size;
}

void fixture_seal(uint8_t *blob, size_t size)
{
    writer_t w = { blob, 4, 12 };
    put(&w, (uint32_t)size, 4);
    put(&w, fixture_crc32(blob + 12, size - 12), 4);
}
