// The elements in Svelte's templates: `import type {} from "labial/svelte"`.
import type { HTMLAttributes } from "svelte/elements";
import type { LabialFace } from "./labial-face.js";
import type { LabialMouth } from "./labial-mouth.js";
import type { Settings } from "./elements.js";

declare module "svelte/elements" {
    interface SvelteHTMLElements {
        "labial-face": HTMLAttributes<LabialFace> & Settings<LabialFace> & { for?: string };
        "labial-mouth": HTMLAttributes<LabialMouth> & Settings<LabialMouth> & { for?: string };
    }
}
