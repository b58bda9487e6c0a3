// @ts-check
/** How far something is that takes a while: how many, at which rate, and about how much longer it takes. */

/** Before so much time has passed nobody knows a rate (ms). */
const SOON_MS = 400;

/**
 * The words, from its beginning on.
 * @param {() => number} [now] milliseconds
 */
export function howFar(now = () => performance.now()) {
  const began = now();
  /**
   * @param {number} done
   * @param {number} [total] all of them; 0: nobody knows
   */
  return (done, total = 0) => {
    const passed = now() - began;
    const count = done.toLocaleString("en");
    const rate = (1000 * done) / passed;
    if (passed < SOON_MS || rate < 1) return `${count} …`;
    const words = `${count}, ${Math.round(rate).toLocaleString("en")} a second`;
    if (!total) return words;
    return done < total ? `${words}, about ${Math.round((total - done) / rate).toLocaleString("en")} s left` : `${count} …, reading what has occurred`;
  };
}
