// Clocks by which a voice is heard: how many seconds of its sound have reached the listener.

/** For streams that come without a context. */
let shared;

/** What reads a clock: `read` returns seconds, or null while nothing is heard. `anchored` where the clock runs before
 * the voice does, so that begin() must say when it begins. */
export function clockOf({ shown }, clock, context) {
    if (clock == null) return null;
    if (typeof clock === "function") return { read: () => clock() ?? null, anchored: false };
    if (typeof clock === "object") {
        if ("destination" in clock && "currentTime" in clock) return { read: () => heard(clock), anchored: true };
        if ("play" in clock && "currentTime" in clock) return { read: reader(clock), anchored: false };
        if ("getAudioTracks" in clock) {
            const own = context ?? (shared ??= new AudioContext());
            if (own === shared) Promise.resolve(own.resume()).catch(() => {}); // waits for a click
            return { read: () => heard(own), anchored: true };
        }
    }
    const kinds = "an AudioContext, a media element, a MediaStream or a function";
    throw new TypeError(`the clock is ${shown(clock)}, not ${kinds}`);
}

/** The time of an AudioContext that is heard now: what is computed at `currentTime` is heard later. */
function heard(context) {
    return context.currentTime - (context.outputLatency || context.baseLatency || 0);
}

/** What tells the time of an element that is heard now, for which the browser allows for the device. Behind the sound's
 * end time goes on, so that the lips come to rest. */
function reader(element) {
    let end = null; // when it had ended
    return () => {
        const { currentTime, ended, paused, readyState } = element;
        end = ended ? end ?? Date.now() : null;
        if (currentTime === 0 && (paused || readyState < 3)) return null;
        return end === null ? currentTime : currentTime + (Date.now() - end) / 1000;
    };
}
