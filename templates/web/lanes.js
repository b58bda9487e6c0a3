// @ts-check
/** The lanes of the time axis: who did what when, and when which steps occurred. */

const MOST_LANES = 14;

/** @typedef {{key: string, name: string, y: number, height: number, isFolded?: boolean, bars: any[], ticks: Float64Array | number[], steps: number[], party: number}} Lane */

/**
 * @param {any} run
 * @param {import("./course.js").Course} course
 * @returns {Lane[]}
 */
export function lanesOf(run, course) {
  return run.happenings ? partyLanes(run, course) : pageLanes(run, course);
}

/**
 * A run goes on: more bars (`bars` by party, activities are those of party 0), and steps.
 * @param {Lane[]} lanes
 * @param {any} run
 * @param {import("./course.js").Course} course
 * @param {{bars: any[], activities: any[], from: number}} more `from`: the first step that is new
 */
export function growLanes(lanes, run, course, { bars, activities, from }) {
  const { owners } = run.happenings;
  for (let k = from; k <= course.steps; k++) {
    const lane = lanes[owners[course.transition[k - 1]]];
    lane.steps.push(k);
    /** @type {number[]} */ (lane.ticks).push(course.time[k - 1]);
  }
  for (const lane of lanes) while (lane.bars[lane.bars.length - 1]?.isOpen) lane.bars.pop();
  for (const a of activities) lanes[0].bars.push({ ...a, kind: "activity", label: a.name, transition: -1, party: 0 });
  for (const bar of bars) lanes[bar.party].bars.push(bar);
}

/**
 * A lane for the activities, one for each party.
 * @param {any} run
 * @param {import("./course.js").Course} course
 * @returns {Lane[]}
 */
function partyLanes(run, course) {
  const { parties, bars, activities, owners } = run.happenings;
  /** @type {number[][]} */
  const steps = parties.map(() => []);
  for (let k = 1; k <= course.steps; k++) steps[owners[course.transition[k - 1]]].push(k);
  const lanes = parties.map((/** @type {any} */ p, /** @type {number} */ i) => ({
    key: String(i), name: p.name, y: 0, height: 0, party: i, steps: steps[i], ticks: steps[i].map((/** @type {number} */ k) => course.time[k - 1]),
    bars: i === 0
      ? activities.map((/** @type {any} */ a) => ({ ...a, kind: "activity", label: a.name, transition: -1, party: 0 }))
      : bars.filter((/** @type {any} */ b) => b.party === i),
  }));
  return lanes;
}

/**
 * Of a net without parties: a lane for each page instance on which something occurs, the busiest ones.
 * @param {any} run
 * @param {import("./course.js").Course} course
 * @returns {Lane[]}
 */
function pageLanes(run, course) {
  /** @type {Map<number, number[]>} */
  const found = new Map();
  for (let k = 1; k <= course.steps; k++) {
    const at = course.occurred(k).instance;
    if (!found.has(at)) found.set(at, []);
    found.get(at)?.push(k);
  }
  const busiest = [...found].sort((a, b) => b[1].length - a[1].length).slice(0, MOST_LANES).map(([at]) => at);
  return busiest.sort((a, b) => a - b).map((at) => {
    const steps = found.get(at) ?? [];
    const path = run.net.instances[at]?.path.split("/").pop() ?? "net";
    return { key: String(at), name: path, y: 0, height: 0, party: -1, bars: [], steps, ticks: steps.map((k) => course.time[k - 1]) };
  });
}
