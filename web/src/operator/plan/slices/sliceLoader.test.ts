import { beforeEach, describe, expect, test } from "vitest";
import { SliceLoader, SliceRepository } from "./sliceLoader";

/** A server that answers on command. */
class Slow {
  requested: string[] = [];
  private waiting = new Map<string, { give: (slice: string) => void; reject: (why: Error) => void }>();

  load = (key: string): Promise<string> => {
    this.requested.push(key);
    return new Promise((give, reject) => this.waiting.set(key, { give, reject }));
  };

  async answer(key: string): Promise<void> {
    this.waiting.get(key)?.give(`slice ${key}`);
    await settled();
  }

  async reject(key: string): Promise<void> {
    this.waiting.get(key)?.reject(new Error("no"));
    await settled();
  }
}

const settled = async (): Promise<void> => {
  for (let i = 0; i < 5; i += 1) await Promise.resolve();
};

let server: Slow;
let loader: SliceLoader<string>;
beforeEach(() => {
  server = new Slow();
  loader = new SliceLoader(server.load, new SliceRepository(10));
});

describe("slices while a finger moves", () => {
  test("one is asked for at a time, and what was passed over is never asked for", async () => {
    for (const key of ["1", "2", "3", "4"]) loader.request(key);
    expect(server.requested).toEqual(["1"]);
    await server.answer("1");
    expect(loader.snapshot().shown?.key).toBe("1");
    expect(server.requested).toEqual(["1", "4"]);
    await server.answer("4");
    expect(loader.snapshot()).toMatchObject({ requested: "4", shown: { key: "4", slice: "slice 4" } });
  });

  test("an older picture does not take the place of a newer one from the shelf", async () => {
    loader.request("1");
    await server.answer("1");
    loader.request("2");
    loader.request("1");
    expect(loader.snapshot().shown?.key).toBe("1");
    await server.answer("2");
    expect(loader.snapshot().shown?.key).toBe("1");
  });

  test("a picture that was only fetched ahead is not shown", async () => {
    loader.request("1", ["2", "0"]);
    await server.answer("1");
    await server.answer("2");
    expect(loader.snapshot().shown?.key).toBe("1");
    await server.answer("0");
    loader.request("2");
    expect(loader.snapshot().shown?.key).toBe("2");
    expect(server.requested).toEqual(["1", "2", "0"]);
  });

  test("during a prefetch, the wanted slice is loaded next", async () => {
    loader.request("1", ["2", "3"]);
    await server.answer("1");
    loader.request("9", []);
    await server.answer("2");
    expect(loader.snapshot().shown?.key).toBe("1");
    expect(server.requested).toEqual(["1", "2", "9"]);
  });
});

describe("a slice that cannot be had", () => {
  test("keeps the previous slice, reports the failure, and is retried on request", async () => {
    loader.request("1");
    await server.answer("1");
    loader.request("2");
    await server.reject("2");
    expect(loader.snapshot()).toMatchObject({ shown: { key: "1" }, problem: new Error("no") });
    loader.retry();
    await server.answer("2");
    expect(loader.snapshot()).toMatchObject({ shown: { key: "2" }, problem: null });
  });

  test("is ignored if only a neighbour is rejected", async () => {
    loader.request("1", ["2", "3"]);
    await server.answer("1");
    await server.reject("2");
    expect(loader.snapshot().problem).toBeNull();
    expect(server.requested).toEqual(["1", "2", "3"]);
  });
});

test("the least recently used slice is evicted first", () => {
  const repository = new SliceRepository<number>(2);
  repository.put("a", 1);
  repository.put("b", 2);
  repository.get("a");
  repository.put("c", 3);
  expect([repository.get("a"), repository.get("b"), repository.get("c")]).toEqual([1, undefined, 3]);
});
