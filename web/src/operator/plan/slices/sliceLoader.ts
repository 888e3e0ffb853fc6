// Loads one slice at a time; the newest request is served next, and an older slice never replaces a newer one.
// When idle, it prefetches the neighbours.

export interface SliceState<Slice> {
  /** The last request. */
  requested: string | null;
  /** The displayed picture and its key. */
  shown: { key: string; slice: Slice } | null;
  /** Why the requested slice could not be loaded. */
  problem: unknown;
}

type LoadSlice<Slice> = (key: string) => Promise<Slice>;

/** Cache of loaded slices; evicts the least recently used. */
export class SliceRepository<Slice> {
  private readonly slices = new Map<string, Slice>();

  constructor(private readonly maxSlices: number) {}

  get(key: string): Slice | undefined {
    const slice = this.slices.get(key);
    if (slice !== undefined) {
      this.slices.delete(key);
      this.slices.set(key, slice);
    }
    return slice;
  }

  put(key: string, slice: Slice): void {
    this.slices.set(key, slice);
    for (const old of this.slices.keys()) {
      if (this.slices.size <= this.maxSlices) return;
      this.slices.delete(old);
    }
  }
}

export class SliceLoader<Slice> {
  private state: SliceState<Slice> = { requested: null, shown: null, problem: null };
  private readonly listeners = new Set<() => void>();
  private loading = false;
  private ahead: string[] = [];

  constructor(
    private readonly load: LoadSlice<Slice>,
    private readonly repository: SliceRepository<Slice>,
  ) {}

  /** Requests a slice, with likely next ones for prefetching. */
  request(key: string, ahead: readonly string[] = []): void {
    this.ahead = [...ahead];
    if (key !== this.state.requested) {
      const stored = this.repository.get(key);
      const shown = stored === undefined ? this.state.shown : { key, slice: stored };
      this.publish({ requested: key, shown, problem: null });
    }
    void this.next();
  }

  /** Retries a failed request. */
  retry(): void {
    this.publish({ ...this.state, problem: null });
    void this.next();
  }

  subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  snapshot = (): SliceState<Slice> => this.state;

  private async next(): Promise<void> {
    if (this.loading) return;
    const { requested, shown, problem } = this.state;
    const isRequested = requested !== null && problem === null && shown?.key !== requested;
    const key = isRequested ? requested : this.ahead.find((one) => this.repository.get(one) === undefined);
    if (key === undefined) return;
    this.loading = true;
    try {
      this.take(key, await this.load(key), isRequested);
    } catch (error) {
      this.ahead = this.ahead.filter((one) => one !== key);
      if (key === this.state.requested) this.publish({ ...this.state, problem: error });
    } finally {
      this.loading = false;
    }
    void this.next();
  }

  private take(key: string, slice: Slice, wasRequested: boolean): void {
    this.repository.put(key, slice);
    const { requested, shown } = this.state;
    // Intermediate slices may be shown while loading, since each has its own position labels. A slice from the cache is
    // already the requested one, so nothing older may follow it.
    if (key === requested || (wasRequested && shown?.key !== requested)) {
      this.publish({ ...this.state, shown: { key, slice } });
    }
  }

  private publish(state: SliceState<Slice>): void {
    this.state = state;
    for (const listener of this.listeners) listener();
  }
}
