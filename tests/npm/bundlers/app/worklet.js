import laughter from "labial-laughter";
import * as words from "labial-words";
import { frames, spoken } from "./lips.js";

registerProcessor("lips", class extends AudioWorkletProcessor {
    constructor() {
        super();
        Promise.all([frames(laughter), spoken(words)])
            .then((found) => this.port.postMessage(found.flat()), (error) => this.port.postMessage(String(error)));
    }

    process() {
        return true;
    }
});
