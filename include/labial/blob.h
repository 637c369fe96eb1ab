/*
 * labial/blob.h - blobs: models from files or flash pages instead of compiled-in tables.
 *
 * A blob is a model as bytes; `labial export --blob` writes it as the file NAME.lbm. It is little-endian and is used in
 * place: nothing is copied, and the bytes must stay where they are for as long as the model is used. A blob is not
 * trusted: labial_model_load() checks every length before it uses a pointer, and labial_model_check() every value. An
 * accepted model plays safely, but may take several times the work of the bundled models: labial_model_cost()
 * (labial/model.h) returns how much.
 *
 *   bytes 0-3    "LBM1"
 *   bytes 4-7    size of the whole model in bytes, uint32
 *   bytes 8-11   CRC-32 (the one of zlib and PNG) of all that follows, uint32
 *   bytes 12-27  format, frames_per_second, component_count (uint16); phoneme_count, class_count, state_count,
 *                predecessor_fours, search_stride, silence, mixture_mean, kernel_taps, kernel_stride, kernel_behind
 *                (uint8)
 *   byte 28      which optional tables follow: 1 contexts, 2 slopes, 8 protrusion; 4: pairs have two knots
 *   byte 29      floor_count (uint8)
 *   bytes 30-31  pair_count (uint16)
 *   bytes 32-45  channel_count, sources (uint8)
 *   bytes 46-47  0
 *   then the tables of labial_model_t in their order, each padded with zeros to a multiple of four bytes: phonemes,
 *   components, contexts, shapes, slopes, kernels, pair_keys, pairs, floors, contacts, protrusion; and for
 *   each channel centre (int16), shape_scale, slope_scale, kernel_scale, pair_scale, both motion_scale (uint16),
 *   contact_weight (uint8), 0 (uint8), then emissions, states, transitions, initials
 */
#ifndef LABIAL_BLOB_H
#define LABIAL_BLOB_H

#include <stddef.h>

#include "labial/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A model whose tables are in a blob, and the channels that it points to. The caller owns it and must not move it once
 * it is loaded. */
typedef struct {
    labial_model_t model;
    labial_channel_t channels[LABIAL_CHANNELS];
} labial_blob_t;

/*
 * Makes `blob->model` refer to the `size` bytes at `data`, which must be aligned to four; `size` must be the size that
 * the blob's header states.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_VERSION (another format, or a big-endian machine) or
 * LABIAL_ERROR_MODEL (misaligned, truncated, damaged, or out of range).
 */
int labial_model_load(labial_blob_t *blob, const void *data, size_t size);

#ifdef __cplusplus
}
#endif

#endif
