// The newest slice wins: one picture is asked for at a time, what was asked meanwhile comes next, and an older
// picture never takes the place of a newer one. When nothing is asked, the neighbours are fetched ahead.

export interface SliceState<Slice> {
  /** What was asked for last. */
  wanted: string | null;
  /** The picture that stands there, and under which key it was asked for. */
  shown: { key: string; slice: Slice } | null;
  /** Why the one that is wanted cannot be had. */
  problem: unknown;
}

export type Load<Slice> = (key: string) => Promise<Slice>;

/** What was loaded, the longest unused first to go. */
export class SliceRepository<Slice> {
  private readonly kept = new Map<string, Slice>();

  constructor(private readonly most: number) {}

  get(key: string): Slice | undefined {
    const slice = this.kept.get(key);
    if (slice !== undefined) {
      this.kept.delete(key);
      this.kept.set(key, slice);
    }
    return slice;
  }

  put(key: string, slice: Slice): void {
    this.kept.set(key, slice);
    for (const old of this.kept.keys()) {
      if (this.kept.size <= this.most) return;
      this.kept.delete(old);
    }
  }
}

export class SliceLine<Slice> {
  private state: SliceState<Slice> = { wanted: null, shown: null, problem: null };
  private readonly listeners = new Set<() => void>();
  private loading = false;
  private ahead: string[] = [];

  constructor(
    private readonly load: Load<Slice>,
    private readonly repository: SliceRepository<Slice>,
  ) {}

  /** Ask for a slice, and say which may be asked for next. */
  ask(key: string, ahead: readonly string[] = []): void {
    this.ahead = [...ahead];
    if (key !== this.state.wanted) {
      const kept = this.repository.get(key);
      const shown = kept === undefined ? this.state.shown : { key, slice: kept };
      this.tell({ wanted: key, shown, problem: null });
    }
    void this.next();
  }

  /** Ask again for what could not be had. */
  again(): void {
    this.tell({ ...this.state, problem: null });
    void this.next();
  }

  subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  snapshot = (): SliceState<Slice> => this.state;

  private async next(): Promise<void> {
    if (this.loading) return;
    const { wanted, shown, problem } = this.state;
    const isWanted = wanted !== null && problem === null && shown?.key !== wanted;
    const key = isWanted ? wanted : this.ahead.find((one) => this.repository.get(one) === undefined);
    if (key === undefined) return;
    this.loading = true;
    try {
      this.take(key, await this.load(key), isWanted);
    } catch (error) {
      this.ahead = this.ahead.filter((one) => one !== key);
      if (key === this.state.wanted) this.tell({ ...this.state, problem: error });
    } finally {
      this.loading = false;
    }
    void this.next();
  }

  private take(key: string, slice: Slice, wasWanted: boolean): void {
    this.repository.put(key, slice);
    const { wanted, shown } = this.state;
    // Between the one that stands and the one that is wanted it shows that something moves; its own place is
    // printed with it. Where the wanted one stands already, it came from the repository: nothing older follows it.
    if (key === wanted || (wasWanted && shown?.key !== wanted)) {
      this.tell({ ...this.state, shown: { key, slice } });
    }
  }

  private tell(state: SliceState<Slice>): void {
    this.state = state;
    for (const listener of this.listeners) listener();
  }
}
