// @ts-check
/** How much a page may draw here: whether pictures in 3D are made without a GPU, and whether they come too slowly. */

const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
/** A gap between two pictures (ms) that is too long, and how many of them are too many. */
const SLOW_MS = 70;
const MOST_SLOW = 12;
/** A longer one is no sign: the page was in the background. */
const AWAY_MS = 2000;

/**
 * Whether the processor draws what a GPU should; false also where it is not known.
 * @param {WebGLRenderingContext} gl
 */
export function drawsInSoftware(gl) {
  const told = gl.getExtension("WEBGL_debug_renderer_info");
  return SOFTWARE.test(String(gl.getParameter(told ? told.UNMASKED_RENDERER_WEBGL : gl.RENDERER)));
}

/** Notices that pictures come too slowly, again and again. */
export class Thrift {
  constructor() {
    this.last = 0;
    this.slow = 0;
  }

  /**
   * A picture is drawn while the run goes on; whether less should be drawn from now on.
   * @param {number} now
   */
  picture(now) {
    const gap = now - this.last;
    this.last = now;
    if (gap > AWAY_MS) return false;
    this.slow = gap > SLOW_MS ? this.slow + 1 : 0;
    if (this.slow < MOST_SLOW) return false;
    this.slow = 0;
    return true;
  }

  /** The run does not go on: the next gap says nothing. */
  rest() {
    this.last = 0;
  }
}
