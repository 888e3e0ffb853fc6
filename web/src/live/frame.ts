// One message of /ws/view: uint32 little-endian header length, header (JSON), JPEG (may be empty).
import type { LiveMessage } from "./messages";

export interface ViewFrame {
  message: LiveMessage;
  jpeg: Uint8Array<ArrayBuffer>;
}

/** A malformed message. It is dropped with its connection, never guessed at. */
export class BadFrame extends Error {}

const LENGTH_BYTES = 4;
const decoder = new TextDecoder("utf-8", { fatal: true });

export function frameFromBytes(buffer: ArrayBuffer): ViewFrame {
  if (buffer.byteLength < LENGTH_BYTES) {
    throw new BadFrame(`message of ${buffer.byteLength} bytes, at least ${LENGTH_BYTES} needed`);
  }
  const headerBytes = new DataView(buffer).getUint32(0, true);
  const room = buffer.byteLength - LENGTH_BYTES;
  if (headerBytes === 0 || headerBytes > room) {
    throw new BadFrame(`header length ${headerBytes} bytes, allowed 1 to ${room}`);
  }
  const message = headerFromBytes(new Uint8Array(buffer, LENGTH_BYTES, headerBytes));
  return { message, jpeg: new Uint8Array(buffer, LENGTH_BYTES + headerBytes) };
}

function headerFromBytes(bytes: Uint8Array): LiveMessage {
  let text: string;
  try {
    text = decoder.decode(bytes);
  } catch (error) {
    throw new BadFrame("header is not UTF-8", { cause: error });
  }
  return messageFromText(text);
}

/** Parses a live message from JSON: the header of /ws/view, or a message of /ws/live. */
export function messageFromText(text: string): LiveMessage {
  let message: unknown;
  try {
    message = JSON.parse(text);
  } catch (error) {
    throw new BadFrame("message is not JSON", { cause: error });
  }
  if (!isLiveMessage(message)) throw new BadFrame("JSON is not a live message");
  return message;
}

/** The fields are trusted to match the schema; this only recognises a live message. */
function isLiveMessage(value: unknown): value is LiveMessage {
  if (typeof value !== "object" || value === null) return false;
  const fields = value as Record<string, unknown>;
  return (
    Number.isFinite(fields["sequence"]) &&
    Number.isFinite(fields["sent_at_s"]) &&
    // An age that is not a number would never exceed its limit.
    (fields["snapshot"] === null || Number.isFinite(fields["image_age_ms"])) &&
    isRecord(fields["source"]) &&
    isRecord(fields["process"]) &&
    (fields["snapshot"] === null || isSnapshot(fields["snapshot"]))
  );
}

function isSnapshot(value: unknown): boolean {
  return (
    isRecord(value) &&
    Number.isFinite(value["image_number"]) &&
    Number.isFinite(value["captured_at_s"]) &&
    Array.isArray(value["tools"]) &&
    Array.isArray(value["markers"])
  );
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null;
}
