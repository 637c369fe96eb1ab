// Gathers blocks of the mean of all channels and posts them with the time of their first sample. Rates beyond those that
// are heard are lowered by whole factors. The output is silent; it is there so that the browser runs the node.
registerProcessor("labial-tap", class extends AudioWorkletProcessor {
    constructor({ processorOptions: { factor } }) {
        super();
        this.factor = factor;
        this.room = Math.ceil(sampleRate / factor / 100 / 32) * 32;
        this.block = null;
        this.port.onmessage = () => { this.closed = true; };
    }

    process([[input]]) {
        const { factor } = this;
        const count = 128 / factor;
        for (let i = 0; i < count; i++) {
            if (!this.block) {
                this.block = new Float32Array(this.room);
                this.used = 0;
                this.time = currentTime + i * factor / sampleRate;
            }
            let sum = 0;
            for (let j = 0; input && j < factor; j++) sum += input[i * factor + j];
            this.block[this.used++] = sum / factor;
            if (this.used === this.room) {
                this.port.postMessage([this.block, this.time], [this.block.buffer]);
                this.block = null;
            }
        }
        return !this.closed;
    }
});
