/* The mouth of Labial's pages: a frame of 13 facial animation parameters (FAPs) as a drawing.
 *
 * An ES module without imports. `labial page` and the demo put it into their page as it stands, so that no line of it may
 * end a script element; the npm package has it beside <labial-mouth>.
 *
 * The drawing knows nothing but the frame. The outer lip's contour is the neutral mouth's, displaced as FAPs 51 to 60 say
 * at its eight points, smoothly in between; the inner contour moves with it and is kept from crossing itself where the lips
 * touch; FAPs 16 and 17 make a lip fuller or thinner; FAP 3 lowers jaw, lower teeth and chin. */

/** The parameters of a frame, in their order; FAPs 53 and 54 in MW/1024, all others in MNS/1024. */
export const CHANNELS = ["fap3", "fap16", "fap17", "fap51", "fap52", "fap53", "fap54", "fap55", "fap56", "fap57", "fap58",
  "fap59", "fap60"];

export const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

/** The moment to draw, where the clock says `next` and a sound is heard at `heard`: a sound's own position moves in steps, so
 * small differences are closed gradually; the drawing is never more than half a frame period away. */
export const follow = (next, heard, period) => clamp(next + 0.1 * (heard - next), heard - period / 2, heard + period / 2);

/* Drawing units of the two MPEG-4 measures; a FAP is 1/1024 of one. The neutral mouth's line is y = 0, down is positive. */
const MW = 170, MNS = 74, HALF = 85, UPPER = 21, LOWER = 29;
/* Lips that touch press on each other: the first FAP units of opening only relax them. In p, b and m, where lips meet, the
 * talkers' outer contours are up to 75 units farther apart than at rest; in f and v, where they do not, 100 and more. */
const SEAL = 85 * MNS / 1024;

/* Along the mouth, from its right corner to its left one: the angle whose sine is the place, and how thick the neutral
 * lips are there and where their line runs. */
const STATIONS = Array.from({length: 49}, (_, i) => {
  const angle = Math.PI * (i / 48 - 0.5), u = Math.sin(angle), reach = Math.abs(u), arch = 1 - u * u;
  const bow = 1 - 0.2 * Math.exp(-((u / 0.1) ** 2)) + 0.1 * Math.exp(-(((reach - 0.2) / 0.14) ** 2));
  return {angle, u, arch, top: UPPER * Math.pow(1 - reach ** 1.5, 0.95) * bow, bottom: LOWER * Math.pow(arch, 0.9),
    rest: 2.4 * Math.exp(-((u / 0.2) ** 2)) - 1.6 * Math.exp(-(((reach - 0.45) / 0.25) ** 2))};
});

/* How far the contour is displaced at each station, from its displacement at the right corner, half way, in the middle,
 * half way and at the left corner. In the angle whose sine is the place along the mouth, an ellipse is a smooth curve:
 * piecewise cubic interpolation rounds the opening where it is wide and overshoots nowhere. */
function displacement(y) {
  const x = [-Math.PI / 2, -Math.PI / 6, 0, Math.PI / 6, Math.PI / 2], h = [], d = [], m = [];
  for (let i = 0; i < 4; i++) { h[i] = x[i + 1] - x[i]; d[i] = (y[i + 1] - y[i]) / h[i]; }
  for (let i = 1; i < 4; i++)
    m[i] = d[i - 1] * d[i] <= 0 ? 0 : (h[i - 1] + h[i]) * 3 / ((2 * h[i] + h[i - 1]) / d[i - 1] + (h[i] + 2 * h[i - 1]) / d[i]);
  m[0] = 1.25 * d[0] - 0.25 * m[1]; m[4] = 1.25 * d[3] - 0.25 * m[3];
  return STATIONS.map(({angle: at}) => {
    let i = 0;
    while (i < 3 && at > x[i + 1]) i++;
    const t = (at - x[i]) / h[i], s = 1 - t;
    return s * s * (1 + 2 * t) * y[i] + t * s * s * h[i] * m[i] + t * t * (3 - 2 * t) * y[i + 1] - t * t * s * h[i] * m[i + 1];
  });
}

const points = list => list.map(p => p[0].toFixed(1) + " " + p[1].toFixed(1));
const line = list => "M" + points(list).join("L");
/* The way along one contour and back along the other one, both as points() writes them. */
const area = (there, back) => `M${there.join("L")}L${back.slice().reverse().join("L")}Z`;

/** The drawing of a frame: the `d` of each path by its name in the markup, how far the jaw is down, and `gap`, the widest
 * distance between the lips' inner contours; drawing units. `faps` has 13 numbers in the order of CHANNELS. */
export function mouthShape(faps) {
  const [jawOpen, pushLower, pushUpper, midTop, midBottom, stretchLeft, stretchRight, topLeft, topRight, bottomLeft, bottomRight,
    cornerLeft, cornerRight] = faps;
  const mns = value => value * MNS / 1024, mw = value => value * MW / 1024;
  const jaw = Math.max(mns(jawOpen), -4);
  /* x grows towards the face's left, which is on the viewer's right. */
  const left = Math.max(HALF + mw(stretchLeft), 30), right = Math.max(HALF + mw(stretchRight), 30);
  const up = displacement([-cornerRight, topRight, midTop, topLeft, -cornerLeft].map(mns));
  const down = displacement([-cornerRight, -bottomRight, -midBottom, -bottomLeft, -cornerLeft].map(mns));
  /* A lip pushed forward shows more of itself, one drawn back less. */
  const pushTop = clamp(pushUpper / 800, -0.25, 0.3), pushBottom = clamp(pushLower / 800, -0.25, 0.3);

  const outerTop = [], outerBottom = [], innerTop = [], innerBottom = [];
  STATIONS.forEach(({u, top, bottom, rest}, i) => {
    const x = u * (u > 0 ? left : right);
    outerTop.push([x, up[i] - top * (1 + 0.7 * pushTop)]);
    outerBottom.push([x, down[i] + bottom * (1 + 0.7 * pushBottom)]);
    let a = up[i] + rest + SEAL / 2 + 0.3 * top * pushTop, b = down[i] + rest - SEAL / 2 - 0.3 * bottom * pushBottom;
    if (a > b) a = b = (a + b) / 2; /* the lips touch here; they do not pass through each other */
    innerTop.push([0.93 * x, a]);
    innerBottom.push([0.93 * x, b]);
  });
  /* Lips in contact push outwards instead of vanishing. */
  const mid = 24, n = STATIONS.length - 1;
  STATIONS.forEach(({arch}, i) => {
    outerTop[i][1] = Math.min(outerTop[i][1], innerTop[i][1] - 7 * arch);
    outerBottom[i][1] = Math.max(outerBottom[i][1], innerBottom[i][1] + 9 * arch);
  });
  const [ot, ob, it, ib] = [outerTop, outerBottom, innerTop, innerBottom].map(points);
  const between = (a, b, share, from, to) => a.map((p, i) => [p[0] * (1 - share) + b[i][0] * share, p[1] * (1 - share) + b[i][1] * share]).slice(from, to);
  const lowest = outerBottom[mid][1], smile = clamp(mns(cornerLeft + cornerRight) / 24 + mw(stretchLeft + stretchRight) / 60, 0, 1);
  const chin = 158 + jaw, [rx, ry] = outerTop[0], [lx, ly] = outerTop[n];
  const paths = {
    inner: area(it, ib), outer: area(ot, ob), upperLip: area(ot, it), lowerLip: area(ob, ib),
    upperShine: line(between(outerTop, innerTop, 0.3, 15, 34)),
    lowerShine: line(between(outerBottom, innerBottom, 0.52, 15, 34)),
    under: `M${right * -0.5} ${lowest - 1}Q0 ${lowest + 9} ${left * 0.5} ${lowest - 1}`,
    corners: `M${rx + 3} ${ry}L${rx - 3} ${ry + 1}M${lx - 3} ${ly}L${lx + 3} ${ly + 1}`,
    philtrum: `M-8-64Q-9-45-15 ${outerTop[20][1] - 3}M8-64Q9-45 15 ${outerTop[28][1] - 3}`,
    folds: `M-58-88C-76-66 ${rx - 26} ${ry - 32} ${rx - 26} ${ry + 4}M58-88C76-66 ${lx + 26} ${ly - 32} ${lx + 26} ${ly + 4}`,
    crease: `M-34 ${lowest + 22}Q0 ${lowest + 14} 34 ${lowest + 22}`,
    chin: `M-40 ${chin - 40}Q-34 ${chin - 16} 0 ${chin - 14}Q34 ${chin - 16} 40 ${chin - 40}`,
    face: `M-205-200C-206-100-202-20-184 ${44 + 0.35 * jaw}C-168 ${104 + 0.6 * jaw} -78 ${chin} 0 ${chin}` +
          `C78 ${chin} 168 ${104 + 0.6 * jaw} 184 ${44 + 0.35 * jaw}C202-20 206-100 205-200`,
  };
  const opacity = {folds: 0.1 + 0.4 * smile, upperShine: 0.16 + 0.5 * pushTop, lowerShine: 0.24 + 0.5 * pushBottom};
  return {paths, opacity, jaw, gap: Math.max(...innerBottom.map((point, i) => point[1] - innerTop[i][1]))};
}

const MARKUP = `<svg viewBox="-215 -185 430 412" role="img" aria-label="A drawn mouth that moves with the parameters">
  <defs>
    <linearGradient id="backdrop" x2="0" y2="1"><stop stop-color="var(--labial-backdrop-top, #dfe6ee)"/><stop offset="1" stop-color="var(--labial-backdrop-bottom, #c3cedb)"/></linearGradient>
    <radialGradient id="skin" gradientUnits="userSpaceOnUse" cx="0" cy="-40" r="250">
      <stop stop-color="#f0c9ae"/><stop offset=".55" stop-color="#e5b394"/><stop offset="1" stop-color="#c68d6c"/></radialGradient>
    <linearGradient id="neck" x2="0" y2="1"><stop stop-color="#9c6a4e"/><stop offset="1" stop-color="#c48e6f"/></linearGradient>
    <linearGradient id="upper" x2="0" y2="1"><stop stop-color="#c57a72"/><stop offset="1" stop-color="#9a4a4d"/></linearGradient>
    <linearGradient id="lower" x2="0" y2="1"><stop stop-color="#b25b5a"/><stop offset=".45" stop-color="#cd7f78"/><stop offset="1" stop-color="#b3645f"/></linearGradient>
    <linearGradient id="teeth" x2="0" y2="1"><stop stop-color="#b9ada0"/><stop offset=".7" stop-color="#f6f1e8"/><stop offset="1" stop-color="#ece4d6"/></linearGradient>
    <linearGradient id="lowteeth" x2="0" y2="1"><stop stop-color="#e3dacb"/><stop offset="1" stop-color="#a2968a"/></linearGradient>
    <radialGradient id="tongue" cy=".35"><stop stop-color="#c0686a"/><stop offset="1" stop-color="#7d3338"/></radialGradient>
    <filter id="soft" filterUnits="userSpaceOnUse" x="-215" y="-185" width="430" height="460"><feGaussianBlur stdDeviation="3"/></filter>
    <filter id="softer" filterUnits="userSpaceOnUse" x="-215" y="-185" width="430" height="460"><feGaussianBlur stdDeviation="8"/></filter>
    <clipPath id="opening"><path data-d="inner"/></clipPath>
  </defs>
  <rect x="-600" y="-185" width="1200" height="412" fill="url(#backdrop)"/>
  <path d="M-118 40C-112 150-122 200-150 260H150C122 200 112 150 118 40Z" fill="url(#neck)"/>
  <path data-d="face" fill="url(#skin)" stroke="#a8704f" stroke-width="1.5"/>
  <g fill="none" stroke="#8a5237" stroke-linecap="round">
    <path d="M-30-185C-34-140-44-118-50-100M30-185C34-140 44-118 50-100" opacity=".22" stroke-width="5" filter="url(#soft)"/>
    <path d="M-49-106C-60-88-50-70-34-76C-22-80-14-68 0-68C14-68 22-80 34-76C50-70 60-88 49-106" opacity=".6" stroke-width="2"/>
    <path data-d="folds" stroke-width="4" filter="url(#soft)"/>
    <path data-d="philtrum" stroke-width="3" opacity=".3" filter="url(#soft)"/>
    <path data-d="crease" stroke-width="8" opacity=".25" filter="url(#soft)"/>
    <path data-d="chin" stroke-width="9" opacity=".16" filter="url(#softer)"/>
    <path data-d="under" stroke-width="7" opacity=".34" filter="url(#soft)"/>
  </g>
  <ellipse cx="0" cy="-112" rx="13" ry="34" fill="#fff" opacity=".2" filter="url(#softer)"/>
  <path d="M-32-77C-27-85-15-83-12-76C-18-72-26-72-32-77ZM32-77C27-85 15-83 12-76C18-72 26-72 32-77Z" fill="#5b2d1e" opacity=".75"/>
  <path data-d="inner" fill="#2a0b0f"/>
  <g clip-path="url(#opening)">
    <ellipse data-move="jaw" cx="0" cy="14" rx="54" ry="22" fill="url(#tongue)"/>
    <g data-move="jaw"><path d="M-52 40V12Q-40 5-24 4Q0 2 24 4Q40 5 52 12V40Z" fill="url(#lowteeth)"/>
      <path d="M0 3V34M-12 3V34M12 3V34M-24 4V34M24 4V34M-37 6V34M37 6V34" stroke="#8e8174" stroke-width=".8" opacity=".6"/></g>
    <path d="M-66-34V-9Q-48 2-25 4Q-12 8 0 6Q12 8 25 4Q48 2 66-9V-34Z" fill="url(#teeth)"/>
    <path d="M0 6V-30M-17 6V-30M17 6V-30M-31 4V-30M31 4V-30M-44 0V-30M44 0V-30M-56-4V-30M56-4V-30" stroke="#9a8d80" stroke-width=".8" opacity=".6"/>
    <path data-d="inner" fill="none" stroke="#1c0508" stroke-width="8" opacity=".38" filter="url(#soft)"/>
  </g>
  <path data-d="upperLip" fill="url(#upper)"/>
  <path data-d="lowerLip" fill="url(#lower)"/>
  <path data-d="upperShine" fill="none" stroke="#fff" stroke-width="4" stroke-linecap="round" filter="url(#soft)"/>
  <path data-d="lowerShine" fill="none" stroke="#fff" stroke-width="7" stroke-linecap="round" filter="url(#soft)"/>
  <path data-d="outer" fill="none" stroke="#8d4a45" stroke-width="1.2" opacity=".45"/>
  <path data-d="inner" fill="none" stroke="#4d1519" stroke-width="1.8" stroke-linejoin="round" opacity=".85"/>
  <path data-d="corners" fill="none" stroke="#5d2420" stroke-width="5" stroke-linecap="round" opacity=".4" filter="url(#soft)"/>
</svg>`;

let drawings = 0;

/** Appends the SVG elements of a drawing's markup, which has no text, to an element or shadow root. Pages may forbid
 * innerHTML ("trusted types"). Names in one drawing are not meant by another one. */
export function build(place, markup) {
  const own = `labial-${++drawings}-`, open = [place];
  for (const [, closes, name, attributes, empty] of markup.matchAll(/<(\/?)(\w+)([^>]*?)(\/?)>/g)) {
    if (closes) { open.pop(); continue; }
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [, key, value] of attributes.matchAll(/([\w-]+)="([^"]*)"/g))
      element.setAttribute(key, key === "id" ? own + value : value.replace("url(#", `url(#${own}`));
    open[open.length - 1].append(element);
    if (!empty) open.push(element);
  }
}

/** Puts a mouth into an empty element or shadow root and returns the function that draws a frame, as mouthShape() takes it.
 * The colours behind the face are --labial-backdrop-top and --labial-backdrop-bottom. */
export function createMouth(place) {
  build(place, MARKUP);
  const shapes = [...place.querySelectorAll("[data-d]")], jawParts = [...place.querySelectorAll("[data-move=jaw]")];
  return faps => {
    const {paths, opacity, jaw} = mouthShape(faps);
    for (const shape of shapes) {
      const name = shape.dataset.d;
      shape.setAttribute("d", paths[name]);
      if (name in opacity) shape.setAttribute("opacity", opacity[name]);
    }
    for (const part of jawParts) part.setAttribute("transform", `translate(0 ${jaw})`);
  };
}

/* The whole face: flat, in the mouth's drawing units. Lids, brows and gaze are moved by FACE_STYLE and by the frame. */
const FACE = `<svg viewBox="-300 -455 600 690" aria-hidden="true" class="labial-face">
  <defs>
    <linearGradient id="backdrop" x2="0" y2="1"><stop class="top"/><stop offset="1" class="bottom"/></linearGradient>
    <clipPath id="opening"><path data-d="inner"/></clipPath>
    <clipPath id="left"><ellipse cx="96" cy="-178" rx="42" ry="38"/></clipPath>
    <clipPath id="right"><ellipse cx="-96" cy="-178" rx="42" ry="38"/></clipPath>
    <clipPath id="head"><path data-d="head"/></clipPath>
  </defs>
  <rect x="-1500" y="-1500" width="3000" height="3000" fill="url(#backdrop)"/>
  <path class="clothes" d="M-270 400C-262 262-190 214-74 196H74C190 214 262 262 270 400Z"/>
  <path class="neck" d="M-72 90V196C-60 236 60 236 72 196V90Z"/>
  <path class="shade" data-d="below"/>
  <ellipse class="ear" cx="-228" cy="-140" rx="30" ry="46"/><ellipse class="ear" cx="228" cy="-140" rx="30" ry="46"/>
  <path class="skin" data-d="head"/>
  <g clip-path="url(#head)">
    <ellipse class="blush" cx="-150" cy="-62" rx="46" ry="30"/><ellipse class="blush" cx="150" cy="-62" rx="46" ry="30"/>
  </g>
  <path class="hair" d="M-238-150C-262-330-150-428 4-428C160-428 262-330 238-150C232-196 222-232 204-262C150-262 84-290 40-334C-20-280-130-262-200-270C-222-236-232-200-238-150Z"/>
  <g clip-path="url(#left)">
    <ellipse class="white" cx="96" cy="-178" rx="41" ry="37"/>
    <g class="gaze"><circle class="iris" cx="96" cy="-178" r="27"/><circle class="pupil" cx="96" cy="-178" r="15"/><circle class="light" cx="105" cy="-189" r="8"/></g>
    <path class="skin" data-part="cheek" d="M36-60V-134Q96-148 156-134V-60Z"/>
    <path class="skin" d="M36-300V-196Q96-216 156-196V-300Z"/>
    <path class="skin lid" d="M36-320V-150Q96-134 156-150V-320Z"/>
  </g>
  <g clip-path="url(#right)">
    <ellipse class="white" cx="-96" cy="-178" rx="41" ry="37"/>
    <g class="gaze"><circle class="iris" cx="-96" cy="-178" r="27"/><circle class="pupil" cx="-96" cy="-178" r="15"/><circle class="light" cx="-87" cy="-189" r="8"/></g>
    <path class="skin" data-part="cheek" d="M-156-60V-134Q-96-148 -36-134V-60Z"/>
    <path class="skin" d="M-156-300V-196Q-96-216 -36-196V-300Z"/>
    <path class="skin lid" d="M-156-320V-150Q-96-134 -36-150V-320Z"/>
  </g>
  <path class="lash" d="M54-182Q62-206 96-207Q130-206 138-182M-54-182Q-62-206-96-207Q-130-206-138-182"/>
  <path class="brow" data-part="brow" d="M58-246Q98-268 142-244M-58-246Q-98-268-142-244"/>
  <path class="nose" d="M-20-92Q0-76 20-92"/>
  <g transform="scale(1.2)">
    <path class="crease" data-d="crease"/>
    <path class="hollow" data-d="inner"/>
    <g clip-path="url(#opening)">
      <path class="tongue" data-part="tongue" d="M-60 90C-66 30-42 0-3 6C42 0 66 30 60 90Z"/>
      <path class="teeth under" data-move="jaw" d="M-52 60V17Q0 4 52 17V60Z"/>
      <path class="teeth" d="M-82-60V0Q-46 12 0 13Q46 12 82 0V-60Z"/>
    </g>
    <path class="upper" data-d="upperLip"/>
    <path class="lower" data-d="lowerLip"/>
    <path class="shine" data-d="lowerShine"/>
    <path class="line" data-d="inner"/>
  </g>
</svg>`;

const FACE_STYLE = `
.labial-face { --skin: var(--labial-skin, light-dark(#e9b18f, #d09c7d)); --lips: var(--labial-lips, light-dark(#c8716a, #b1605a));
  --hair: var(--labial-hair, light-dark(#4b3a36, #43352f)) }
.labial-face .top { stop-color: var(--labial-backdrop-top, light-dark(#e8eef5, #36414e)) }
.labial-face .bottom { stop-color: var(--labial-backdrop-bottom, light-dark(#c9d5e2, #171c23)) }
.labial-face .skin { fill: var(--skin) }
.labial-face .ear { fill: color-mix(in oklab, var(--skin), #8a3d24 12%) }
.labial-face .neck { fill: color-mix(in oklab, var(--skin), #6b2a18 16%) }
.labial-face .shade { fill: color-mix(in oklab, var(--skin), #6b2a18 34%) }
.labial-face .blush { fill: #d9574a; opacity: .16 }
.labial-face .clothes { fill: var(--labial-clothes, light-dark(#5b7fa6, #40597a)) }
.labial-face .hair { fill: var(--hair) }
.labial-face .white { fill: light-dark(#fff, #eee9e4) }
.labial-face .iris { fill: var(--labial-iris, #7a5236) }
.labial-face .pupil { fill: #1c1a1d }
.labial-face .light { fill: #fff; opacity: .9 }
.labial-face :is(.lash, .brow, .nose, .crease, .shine, .line) { fill: none; stroke-linecap: round; stroke-linejoin: round }
.labial-face .lash { stroke: var(--hair); stroke-width: 7 }
.labial-face .brow { stroke: var(--hair); stroke-width: 13 }
.labial-face .nose { stroke: color-mix(in oklab, var(--skin), #6b2a18 42%); stroke-width: 7 }
.labial-face .crease { stroke: color-mix(in oklab, var(--skin), #6b2a18 24%); stroke-width: 6 }
.labial-face .hollow { fill: #3a0f14 }
.labial-face .tongue { fill: #cf6a6d }
.labial-face .teeth { fill: #fbf8f2 }
.labial-face .teeth.under { fill: #ece5da }
.labial-face .upper { fill: color-mix(in oklab, var(--lips), #3a0f14 16%) }
.labial-face .lower { fill: var(--lips) }
.labial-face .shine { stroke: #fff; stroke-width: 5; opacity: .2 }
.labial-face .line { stroke: #3a0f14; stroke-width: 3 }
.labial-face .lid { transform: translateY(-90px); animation: labial-blink 11s infinite }
.labial-face .lash { transform-origin: 0 -176px; animation: labial-lash 11s infinite }
.labial-face .gaze { animation: labial-gaze 17s infinite }
@keyframes labial-blink {
  0%, 26.6%, 28.8%, 61%, 63.2%, 64%, 66.2%, 100% { transform: translateY(-90px) }
  27.5%, 61.9%, 64.9% { transform: none }
}
@keyframes labial-lash {
  0%, 26.6%, 28.8%, 61%, 63.2%, 64%, 66.2%, 100% { transform: none }
  27.5%, 61.9%, 64.9% { transform: scaleY(-.8) }
}
@keyframes labial-gaze {
  0%, 31%, 43%, 70%, 82%, 100% { transform: none }
  31.8%, 42.2% { transform: translate(7px, 1px) }
  70.8%, 81.2% { transform: translate(-6px, -2px) }
}
@media (prefers-reduced-motion: reduce) { .labial-face :is(.lid, .lash, .gaze) { animation: none } }
`;

/** The head's outline and what shows of the lips' surroundings, for a jaw that is `jaw` units down. */
function headShape(jaw) {
  const chin = 126 + 0.9 * jaw, cheek = 40 + 0.35 * jaw;
  const half = side => `C${side * 138}-410 ${side * 232}-310 ${side * 232}-170C${side * 232} ${cheek} ${side * 118} ${chin} 0 ${chin}`;
  return {
    head: `M0-410${half(1)}C-118 ${chin}-232 ${cheek}-232-170C-232-310-138-410 0-410Z`,
    below: `M-72 90V${chin + 24}Q0 ${chin + 62} 72 ${chin + 24}V90Z`,
  };
}

/** What the face's mouth draws of a frame. At rest it smiles a little. In f and v upper teeth stand on the lower lip: lips are
 * near each other, but the upper one has not come down as in p, b and m (FAP 51 is above 80 there and below 20 here), and
 * the jaw is not at rest. Then the upper lip is drawn higher, so that the teeth are seen. */
export function faceFrame(faps) {
  const frame = Array.from(faps), [jaw, , , top, bottom] = frame;
  const near = 170 + top + bottom, teeth = clamp(near / 80, 0, 1) * clamp((70 - top) / 50, 0, 1) * clamp((jaw - 40) / 80, 0, 1);
  const lift = (80 + clamp(near, 0, 220)) * teeth;
  frame[3] -= lift; frame[7] -= 0.75 * lift; frame[8] -= 0.75 * lift;
  for (const corner of [11, 12]) frame[corner] += 70;
  return frame;
}

/** Puts a whole face into an empty element or shadow root and returns the function that draws a frame. */
export function createFace(place) {
  build(place, FACE);
  const root = place.getRootNode(), sheet = new CSSStyleSheet();
  sheet.replaceSync(FACE_STYLE);
  root.adoptedStyleSheets = [...(root.adoptedStyleSheets ?? []), sheet]; /* which jsdom lacks, as matchMedia */
  const all = selector => [...place.querySelectorAll(selector)], move = (parts, y) => {
    for (const part of parts) part.setAttribute("transform", `translate(0 ${y.toFixed(1)})`);
  };
  const shapes = all("[data-d]"), [jaws, brows, cheeks, tongue] =
    ["[data-move=jaw]", "[data-part=brow]", "[data-part=cheek]", "[data-part=tongue]"].map(all);
  const delay = `${-drawings * 3.7 % 11}s`; /* not all faces blink at once */
  for (const part of all(".lid, .lash, .gaze")) part.style.animationDelay = delay;
  const still = globalThis.matchMedia?.("(prefers-reduced-motion: reduce)");
  let lift = 0;
  return faps => {
    const {paths, jaw} = mouthShape(faceFrame(faps)), drawn = {...paths, ...headShape(jaw)};
    for (const shape of shapes) shape.setAttribute("d", drawn[shape.dataset.d]);
    move(jaws, jaw);
    /* Of a rounded mouth the tongue is farther back, in the dark. */
    move(tongue, 4 + 0.45 * jaw + 0.5 * clamp(-(faps[5] + faps[6]), 0, 100));
    /* Corners that rise press the cheeks to the eyes; brows follow the jaw, slowly. */
    const smile = clamp((faps[11] + faps[12]) / 500, 0, 1);
    lift += 0.12 * (clamp(jaw / 4 - 14 * smile, -12, 11) - lift);
    move(brows, still?.matches ? 0 : -lift);
    move(cheeks, -26 * smile);
  };
}
