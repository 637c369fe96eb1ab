// A server draws nothing, but the page's modules are imported there.
import "labial/labial-mouth.js";
import { frames } from "./lips.js";

frames(() => import("labial-laughter")).then((found) => console.log(JSON.stringify(found)));
