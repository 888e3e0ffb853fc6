// Uploads and downloads in one piece with progress; both can be cancelled.
import { Rejection } from "../../rest/client";
import { pageLanguage } from "../../texts/pageLanguage";
import { parsed, problemIn } from "./problem";

export interface TransferredBytes {
  doneBytes: number;
  /** 0 while the total is unknown. */
  allBytes: number;
}

export type OnProgress = (moved: TransferredBytes) => void;

/**
 * Sends a file as the body of a request. Uses XMLHttpRequest, since `fetch` reports no upload progress.
 *
 * @throws Rejection, or a DOMException AbortError if cancelled
 */
export function uploadFile<Answer>(
  path: string,
  body: Blob,
  onMoved: OnProgress,
  signal: AbortSignal,
): Promise<Answer> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open("POST", path);
    request.setRequestHeader("Content-Type", body.type || "application/octet-stream");
    request.setRequestHeader("Accept-Language", pageLanguage());
    request.upload.onprogress = (event): void => {
      onMoved({ doneBytes: event.loaded, allBytes: event.lengthComputable ? event.total : body.size });
    };
    request.onload = (): void => {
      if (request.status >= 200 && request.status < 300) resolve(parsed(request.responseText) as Answer);
      else reject(new Rejection(problemIn(request.responseText, request.status)));
    };
    request.onerror = (): void => {
      reject(new Rejection(problemIn("", 0)));
    };
    request.onabort = (): void => {
      reject(new DOMException("stopped", "AbortError"));
    };
    signal.addEventListener("abort", () => {
      request.abort();
    });
    request.send(body);
  });
}

/**
 * Fetches a file.
 *
 * @throws Rejection, or a DOMException AbortError if cancelled
 */
export async function downloadFile(path: string, onMoved: OnProgress, signal: AbortSignal): Promise<Blob> {
  let answer: Response;
  try {
    answer = await fetch(path, { signal, cache: "no-store", headers: { "Accept-Language": pageLanguage() } });
  } catch (error) {
    if (signal.aborted) throw error;
    throw new Rejection(problemIn("", 0));
  }
  if (!answer.ok) throw new Rejection(problemIn(await answer.text(), answer.status));
  const allBytes = Number(answer.headers.get("Content-Length") ?? "0");
  const parts: Uint8Array<ArrayBuffer>[] = [];
  let doneBytes = 0;
  const reader = answer.body?.getReader();
  try {
    for (let next = await reader?.read(); next?.done === false; next = await reader?.read()) {
      parts.push(next.value);
      doneBytes += next.value.byteLength;
      onMoved({ doneBytes, allBytes });
    }
  } catch (error) {
    if (signal.aborted) throw error;
    throw new Rejection(problemIn("", 0));
  }
  return new Blob(parts, { type: answer.headers.get("Content-Type") ?? "" });
}
