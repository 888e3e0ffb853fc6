const LOOPBACK = /^(localhost|127(\.\d+){3}|\[::1\])$/;

/** Whether a page from this host has its server on its own machine: no line lies between them. */
export function isLoopback(hostname: string): boolean {
  return LOOPBACK.test(hostname);
}
