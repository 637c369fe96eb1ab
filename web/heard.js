// The time of a sound that a page plays.

const ends = new WeakMap(); // of the elements whose sound has ended: when it was seen first, milliseconds

/** Seconds of a media element's sound. Behind the sound's end, where an element's own time stands, time goes on: a track
 * has frames behind its last phoneme, in which the mouth comes to rest. */
export function heard(audio) {
    if (!audio.ended) {
        ends.delete(audio);
        return audio.currentTime;
    }
    const now = performance.now();
    if (!ends.has(audio)) ends.set(audio, now);
    return audio.currentTime + (now - ends.get(audio)) / 1000;
}
