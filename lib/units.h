/*
 * units.h - phonemes to pieces: the queue of what was pushed, cut into the stretches that are decoded at once.
 *
 * A unit runs from one boundary phoneme (a vowel, p, b, m) to the next inclusive, so that neighbouring units share a
 * phoneme and are cross-faded over it (section 3 of the method):
 *
 *     phonemes   | m |  ey  | b |   iy   | m |  ey  |
 *     pieces     [ m    ey ]
 *                    [ ey    b ]
 *                           [ b    iy ]
 *                               [ iy     m ] ...
 *
 * Units are decoded together until a piece has LABIAL_PIECE frames. A unit longer than the window is cut into chained
 * pieces that share LABIAL_OVERLAP frames. Where the model changes, the earlier model's last piece runs on into the
 * other's phonemes, and the later one's first piece begins with them. No frame ever belongs to more than two pieces,
 * and no piece shares more than half of its frames with the one after it.
 */
#ifndef LABIAL_UNITS_H
#define LABIAL_UNITS_H

#include "labial/labial.h"

/* The i-th segment held, the oldest being 0. */
const labial_segment_t *labial_units_segment(const labial_t *stream, unsigned i);

/* The phoneme of a segment as the model in `slot` sees it: another model's phonemes are silence. */
unsigned labial_units_phoneme(const labial_t *stream, const labial_segment_t *segment, unsigned slot);

/* Appends a segment of at least one frame; the queue must have room. */
void labial_units_push(labial_t *stream, const labial_segment_t *segment);

/*
 * Finds the next piece. What a piece is never depends on when its phonemes were pushed: it is found once the phoneme
 * that follows it and everything that its kernels reach are known, or the stream has ended.
 *
 * Returns LABIAL_OK, LABIAL_WAITING or LABIAL_DONE.
 */
int labial_units_next(labial_t *stream, labial_piece_t *piece);

/* Writes the phoneme of every frame from LABIAL_REACH before the piece to LABIAL_REACH after it, silence where there is
 * none: piece->length + 2 * LABIAL_REACH labels. */
void labial_units_labels(const labial_t *stream, const labial_piece_t *piece, uint8_t *labels);

/* The first segment, counted from the oldest, that holds a frame of the piece; `begin` receives where it starts. */
unsigned labial_units_first(const labial_t *stream, const labial_piece_t *piece, uint32_t *begin);

/* Lets go of the segments that no later piece needs, as phonemes, for its kernels or as context. */
void labial_units_trim(labial_t *stream);

#endif
