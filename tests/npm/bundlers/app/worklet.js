import laughter from "labial-laughter";
import { frames } from "./lips.js";

registerProcessor("lips", class extends AudioWorkletProcessor {
    constructor() {
        super();
        frames(laughter).then((found) => this.port.postMessage(found), (error) => this.port.postMessage(String(error)));
    }

    process() {
        return true;
    }
});
