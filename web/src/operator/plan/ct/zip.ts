// Packs files into an uncompressed zip without copying them, to send CT slices as one body.

const LOCAL = 0x04034b50;
const CENTRAL = 0x02014b50;
const END = 0x06054b50;
const UTF8 = 0x0800;
/** Limits of a zip without the 64-bit extension. */
export const MAX_FILES = 65_000;
export const MAX_BYTES = 2 ** 32 - 2 ** 26;

const TABLE = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; k += 1) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c;
});

export function crc32(bytes: Uint8Array): number {
  let crc = 0xffffffff;
  for (const byte of bytes) crc = (TABLE[(crc ^ byte) & 0xff] ?? 0) ^ (crc >>> 8);
  return (crc ^ 0xffffffff) >>> 0;
}

interface Entry {
  name: Uint8Array<ArrayBuffer>;
  crc: number;
  size: number;
  offset: number;
}

/**
 * Returns a zip of these files.
 *
 * @param files - each is read once for its checksum; the zip refers to the file and contains no copy.
 * @param onRead - is called with the number of files done.
 * @param stop - cancels with an AbortError.
 */
export async function zipFiles(
  files: readonly { name: string; content: Blob }[],
  onRead: (done: number) => void = () => undefined,
  stop?: AbortSignal,
): Promise<Blob> {
  const parts: BlobPart[] = [];
  const entries: Entry[] = [];
  let offset = 0;
  for (const [index, file] of files.entries()) {
    stop?.throwIfAborted();
    const bytes = new Uint8Array(await file.content.arrayBuffer());
    const entry = {
      name: new TextEncoder().encode(file.name),
      crc: crc32(bytes),
      size: bytes.length,
      offset,
    };
    const header = headerOf(entry, false);
    parts.push(header, file.content);
    offset += header.length + entry.size;
    entries.push(entry);
    onRead(index + 1);
  }
  const directory = entries.map((entry) => headerOf(entry, true));
  const size = directory.reduce((sum, one) => sum + one.length, 0);
  return new Blob([...parts, ...directory, endOf(entries.length, size, offset)], { type: "application/zip" });
}

function headerOf(entry: Entry, isCentral: boolean): Uint8Array<ArrayBuffer> {
  const fixed = isCentral ? 46 : 30;
  const bytes = new Uint8Array(fixed + entry.name.length);
  const view = new DataView(bytes.buffer);
  // The directory entry has one more field at its start: the version that made it.
  const shift = isCentral ? 2 : 0;
  view.setUint32(0, isCentral ? CENTRAL : LOCAL, true);
  if (isCentral) view.setUint16(4, 20, true);
  view.setUint16(4 + shift, 20, true);
  view.setUint16(6 + shift, UTF8, true);
  // No modification time: 1 January 1980.
  view.setUint16(12 + shift, 0x21, true);
  view.setUint32(14 + shift, entry.crc, true);
  view.setUint32(18 + shift, entry.size, true);
  view.setUint32(22 + shift, entry.size, true);
  view.setUint16(26 + shift, entry.name.length, true);
  if (isCentral) view.setUint32(42, entry.offset, true);
  bytes.set(entry.name, fixed);
  return bytes;
}

function endOf(count: number, size: number, offset: number): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(22);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, END, true);
  view.setUint16(8, count, true);
  view.setUint16(10, count, true);
  view.setUint32(12, size, true);
  view.setUint32(16, offset, true);
  return bytes;
}
