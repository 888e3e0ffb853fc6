// Upload of files to a job on the server: packed if there are several, sent, and cancelled on request.
import { useRef, useState } from "react";
import { Rejection } from "../../../rest/client";
import type { Job } from "../../../rest/useJob";
import { pageLanguage } from "../../../texts/pageLanguage";
import { uploadCt } from "./send";
import { MAX_BYTES, MAX_FILES, zipFiles } from "./zip";

type Phase = "packing" | "sending" | "fetching";

interface Uploading {
  phase: Phase | null;
  ratio: number;
  rejection: Rejection | null;
  wasStopped: boolean;
  /** Too large for one zip; the page states the remedy. */
  isTooMuch: boolean;
}

const IDLE: Uploading = { phase: null, ratio: 0, rejection: null, wasStopped: false, isTooMuch: false };

export interface Upload extends Uploading {
  send: (files: readonly File[]) => void;
  /** Fetches a file from the server and uploads it, as a user would. */
  sendFrom: (address: string) => void;
  stop: () => void;
}

/** The job that reads the upload; for a CT with the id for choosing a series. */
type Begun = Job & { upload_id?: string };

export function useUpload(address: () => string, onTaken: (begun: Begun) => void): Upload {
  const [state, setState] = useState<Uploading>(IDLE);
  const stopping = useRef<AbortController | null>(null);

  const run = async (body: (stop: AbortSignal) => Promise<Blob | null>): Promise<void> => {
    if (stopping.current !== null) return;
    const stop = new AbortController();
    stopping.current = stop;
    try {
      const content = await body(stop.signal);
      if (content === null) return;
      setState({ ...IDLE, phase: "sending" });
      const answer = await uploadCt<Begun>(
        address(),
        content,
        (ratio) => {
          setState({ ...IDLE, phase: "sending", ratio });
        },
        stop.signal,
      );
      setState(IDLE);
      onTaken(answer);
    } catch (error) {
      if (error instanceof Rejection) setState({ ...IDLE, rejection: error });
      else if (stop.signal.aborted) setState({ ...IDLE, wasStopped: true });
      else throw error;
    } finally {
      stopping.current = null;
    }
  };

  const send = (files: readonly File[]): void => {
    const [first] = files;
    if (first === undefined) return;
    if (files.length === 1) {
      void run(() => Promise.resolve(first));
      return;
    }
    const bytes = files.reduce((sum, file) => sum + file.size, 0);
    if (files.length > MAX_FILES || bytes > MAX_BYTES) {
      setState({ ...IDLE, isTooMuch: true });
      return;
    }
    const named = files.map((file) => ({ name: file.webkitRelativePath || file.name, content: file }));
    void run((stop) =>
      zipFiles(
        named,
        (done) => {
          if (done % 10 === 0) setState({ ...IDLE, phase: "packing", ratio: done / named.length });
        },
        stop,
      ),
    );
  };
  const sendFrom = (from: string): void => {
    void run(async (stop) => {
      setState({ ...IDLE, phase: "fetching" });
      const answer = await fetch(from, { signal: stop, headers: { "Accept-Language": pageLanguage() } });
      if (!answer.ok) throw new Rejection((await answer.json()) as Rejection["problem"]);
      return answer.blob();
    });
  };
  return { ...state, send, sendFrom, stop: () => stopping.current?.abort() };
}
