import { Loader } from "@mantine/core";
import { useEffect, useState, type ReactNode } from "react";
import { RefusalNote } from "../../rest/RefusalNote";
import { Refusal } from "../../rest/client";
import { useWords } from "../../words/WordsContext";
import { fetched } from "../parts/transfer";

/** A picture that belongs to a calibration. It comes as plain bytes, and is only ever shown as a picture. */
export function Plot({ caseId, file, name }: { caseId: string; file: string; name: string }): ReactNode {
  const words = useWords().rest;
  const [address, setAddress] = useState<string | null>(null);
  const [refusal, setRefusal] = useState<Refusal | null>(null);
  useEffect(() => {
    const stop = new AbortController();
    let made: string | null = null;
    fetched(`/api/cases/${caseId}/files/${file}`, () => undefined, stop.signal)
      .then((bytes) => {
        if (stop.signal.aborted) return;
        made = URL.createObjectURL(new Blob([bytes], { type: "image/svg+xml" }));
        setAddress(made);
      })
      .catch((error: unknown) => {
        if (error instanceof Refusal) setRefusal(error);
      });
    return () => {
      stop.abort();
      if (made !== null) URL.revokeObjectURL(made);
    };
  }, [caseId, file]);
  if (refusal !== null) return <RefusalNote refusal={refusal} />;
  if (address === null) return <Loader aria-label={words.loading} />;
  return (
    <figure className="plot">
      <img src={address} alt={name} />
      <figcaption>{name}</figcaption>
    </figure>
  );
}
