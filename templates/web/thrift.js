// @ts-check
/** How much a page may draw here: whether pictures in 3D are made without a GPU, and whether they come too slowly. */

const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
/** What browsers say that hide who draws: WebKit always does. */
const HIDDEN = /^(apple gpu|webkit webgl|mozilla|generic renderer|null)?$/i;
/** What a GPU has drawn in some ms, and a processor has not: so long for it (ms) is too long. */
const PROBE_MS = 25;
const PROBE_SIZE = 256;
const PROBE_VERTEX = "attribute vec2 at; void main() { gl_Position = vec4(at, 0.0, 1.0); }";
const PROBE_FRAGMENT = `
  precision highp float;
  void main() {
    float x = gl_FragCoord.x * 0.01 + gl_FragCoord.y;
    for (int i = 0; i < 256; i++) x = sin(x) + 1.1;
    gl_FragColor = vec4(x);
  }`;
/** A gap between two pictures (ms) that is too long; and how many of them, and for how long (ms), are too many. */
const SLOW_MS = 70;
const FEWEST_SLOW = 3;
const LONGEST_SLOW_MS = 900;

/**
 * Whether the processor draws what a GPU should; where the browser does not tell, it is tried.
 * @param {WebGLRenderingContext} gl
 */
export function drawsInSoftware(gl) {
  const told = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(told ? told.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  return HIDDEN.test(name) ? probed() > PROBE_MS : SOFTWARE.test(name);
}

/** How long a small picture of much arithmetic takes (ms); 0 if that cannot be found out. */
function probed() {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = PROBE_SIZE;
  const gl = canvas.getContext("webgl");
  const program = gl?.createProgram();
  if (!gl || !program) return 0;
  for (const [kind, text] of /** @type {[number, string][]} */ ([[gl.VERTEX_SHADER, PROBE_VERTEX], [gl.FRAGMENT_SHADER, PROBE_FRAGMENT]])) {
    const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  gl.useProgram(program);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 3, -1, -1, 3]), gl.STATIC_DRAW);
  const at = gl.getAttribLocation(program, "at");
  gl.enableVertexAttribArray(at);
  gl.vertexAttribPointer(at, 2, gl.FLOAT, false, 0, 0);
  const pixel = new Uint8Array(4);
  let took = 0;
  for (const size of [1, PROBE_SIZE]) { // the first one also makes the program
    const began = performance.now();
    gl.viewport(0, 0, size, size);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits for it
    took = performance.now() - began;
  }
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return took;
}

/** Notices that pictures come too slowly, again and again. */
export class Thrift {
  constructor() {
    this.last = 0;
    this.many = 0;
    this.slow = 0;
    document.addEventListener("visibilitychange", () => this.rest());
  }

  /**
   * A picture is drawn while the run goes on; whether less should be drawn from now on.
   * @param {number} now
   */
  picture(now) {
    const gap = this.last ? now - this.last : 0;
    this.last = now;
    const isSlow = gap > SLOW_MS;
    this.many = isSlow ? this.many + 1 : 0;
    this.slow = isSlow ? this.slow + gap : 0;
    if (this.many < FEWEST_SLOW || this.slow < LONGEST_SLOW_MS) return false;
    this.many = this.slow = 0;
    return true;
  }

  /** The run does not go on, or nobody sees it: the next gap says nothing. */
  rest() {
    this.last = 0;
  }
}
