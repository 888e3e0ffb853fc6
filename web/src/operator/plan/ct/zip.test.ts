import { expect, test } from "vitest";
import { crc32, zipFiles } from "./zip";

test("the sum of nine digits is the one that every book prints", () => {
  expect(crc32(new TextEncoder().encode("123456789"))).toBe(0xcbf43926);
});

test("the directory leads to each file, whole and under its own name", async () => {
  const files = [
    { name: "series/IM 1", content: new Blob([new Uint8Array([0, 1, 2, 255])]) },
    { name: "series/Ä2.dcm", content: new Blob(["x".repeat(5000)]) },
    { name: "empty", content: new Blob([]) },
  ];
  const done: number[] = [];
  const zip = await zipFiles(files, (count) => done.push(count));
  const found = new DataView(await zip.arrayBuffer());
  const end = found.byteLength - 22;
  expect(found.getUint32(end, true)).toBe(0x06054b50);
  const read: Record<string, number[]> = {};
  let at = found.getUint32(end + 16, true);
  for (let left = found.getUint16(end + 10, true); left > 0; left -= 1) {
    const size = found.getUint32(at + 20, true);
    const named = found.getUint16(at + 28, true);
    const local = found.getUint32(at + 42, true);
    const name = new TextDecoder().decode(new Uint8Array(found.buffer, at + 46, named));
    // The local header before the content has the same name and checksum.
    expect(found.getUint32(local, true)).toBe(0x04034b50);
    expect(found.getUint32(local + 14, true)).toBe(found.getUint32(at + 16, true));
    const content = new Uint8Array(found.buffer, local + 30 + named, size);
    expect(crc32(content)).toBe(found.getUint32(at + 16, true));
    read[name] = [content.length, ...content.slice(0, 4)];
    at += 46 + named;
  }
  expect(at).toBe(end);
  expect(read).toEqual({
    "series/IM 1": [4, 0, 1, 2, 255],
    "series/Ä2.dcm": [5000, 120, 120, 120, 120],
    empty: [0],
  });
  expect(done).toEqual([1, 2, 3]);
});

test("it stops on request", async () => {
  const stop = new AbortController();
  stop.abort();
  await expect(zipFiles([{ name: "a", content: new Blob(["a"]) }], undefined, stop.signal)).rejects.toThrow();
});
