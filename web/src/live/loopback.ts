const LOOPBACK = /^(localhost|127(\.\d+){3}|\[::1\])$/;

/** Whether the server of this host runs on the same machine, without a network in between. */
export function isLoopback(hostname: string): boolean {
  return LOOPBACK.test(hostname);
}
