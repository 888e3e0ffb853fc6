// Keeps the screen on: a hidden page gets no frames.

/** Requests the lock now and whenever the page becomes visible again; reports whether it was granted. */
export function keepScreenOn(signal: AbortSignal, onChange: (isLocked: boolean) => void): void {
  if (!("wakeLock" in navigator)) {
    onChange(false);
    return;
  }
  const locks: WakeLockSentinel[] = [];
  const release = (): void => {
    for (const lock of locks.splice(0)) void lock.release();
  };
  const ask = async (): Promise<void> => {
    if (document.visibilityState !== "visible") return;
    const lock = await navigator.wakeLock.request("screen").catch(() => null);
    if (lock !== null) locks.push(lock);
    // It may have been stopped while the request was pending.
    if (signal.aborted) release();
    else onChange(lock !== null);
  };
  document.addEventListener("visibilitychange", () => void ask(), { signal });
  signal.addEventListener("abort", release);
  void ask();
}
