let found: boolean | null = null;

/** Whether this browser draws 3-D at all; asked once, because each question makes a drawing context. */
export function hasWebGl(): boolean {
  found ??= document.createElement("canvas").getContext("webgl2") !== null;
  return found;
}
