let found: boolean | null = null;

/** Whether this browser supports WebGL 2. Cached, since each check creates a context. */
export function hasWebGl(): boolean {
  found ??= document.createElement("canvas").getContext("webgl2") !== null;
  return found;
}
