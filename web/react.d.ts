// The elements in React's JSX: `import type {} from "labial/react"`.
import type { DetailedHTMLProps, HTMLAttributes } from "react";
import type { LabialFace } from "./labial-face.js";
import type { LabialMouth } from "./labial-mouth.js";
import type { Settings } from "./elements.js";

type Props<E> = DetailedHTMLProps<HTMLAttributes<E>, E> & Settings<E> & { for?: string };

declare module "react" {
    namespace JSX {
        interface IntrinsicElements {
            "labial-face": Props<LabialFace>;
            "labial-mouth": Props<LabialMouth>;
        }
    }
}
