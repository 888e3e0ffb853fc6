// Sends a large file with XMLHttpRequest, since fetch reports no upload progress.
import { NO_ANSWER, Rejection, type Problem } from "../../../rest/client";
import { pageLanguage } from "../../../texts/pageLanguage";

/**
 * Returns the server's answer to a POST of this body.
 *
 * @throws Rejection
 * @throws DOMException - AbortError, after `stop`.
 */
export function uploadCt<Answer>(
  address: string,
  body: Blob,
  onSent: (ratio: number) => void,
  stop: AbortSignal,
): Promise<Answer> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    const noAnswer = new Rejection(NO_ANSWER);
    request.open("POST", address);
    request.setRequestHeader("Content-Type", "application/octet-stream");
    request.setRequestHeader("Accept-Language", pageLanguage());
    request.upload.onprogress = (event) => {
      if (event.lengthComputable) onSent(event.loaded / event.total);
    };
    request.onload = () => {
      try {
        const answer = JSON.parse(request.responseText) as unknown;
        if (request.status < 300) resolve(answer as Answer);
        else reject(new Rejection(answer as Problem));
      } catch {
        reject(noAnswer);
      }
    };
    request.onerror = () => {
      reject(noAnswer);
    };
    request.onabort = () => {
      reject(new DOMException("stopped", "AbortError"));
    };
    stop.addEventListener("abort", () => {
      request.abort();
    });
    request.send(body);
  });
}
