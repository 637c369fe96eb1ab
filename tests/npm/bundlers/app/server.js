// A server draws nothing, but the page's modules are imported there.
import "labial/labial-face.js";
import { frames, heard, spoken } from "./lips.js";

Promise.all([
    frames(() => import("labial-laughter")), heard(() => import("labial-hearing")), spoken(() => import("labial-words")),
]).then((found) => console.log(JSON.stringify(found)));
