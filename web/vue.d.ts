// The elements in Vue's templates and JSX: `import type {} from "labial/vue"`.
import type { DefineComponent, HTMLAttributes } from "vue";
import type { LabialFace } from "./labial-face.js";
import type { LabialMouth } from "./labial-mouth.js";
import type { Settings } from "./elements.js";

type Component<E> = DefineComponent<HTMLAttributes & Settings<E> & { for?: string }>;

declare module "vue" {
    interface GlobalComponents {
        "labial-face": Component<LabialFace>;
        "labial-mouth": Component<LabialMouth>;
    }
}
