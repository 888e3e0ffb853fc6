// Images per second being sent. After a pause it is 0, not the previous rate.

const WINDOW_MS = 2000;

export class Rate {
  private times: number[] = [];

  count(atMs: number): void {
    this.times.push(atMs);
    this.forget(atMs);
  }

  hz(nowMs: number): number {
    this.forget(nowMs);
    const first = this.times[0];
    const last = this.times.at(-1);
    if (first === undefined || last === undefined || last <= first) return 0;
    return ((this.times.length - 1) * 1000) / (last - first);
  }

  private forget(nowMs: number): void {
    this.times = this.times.filter((at) => nowMs - at < WINDOW_MS);
  }
}
