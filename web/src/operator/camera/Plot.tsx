import { Loader } from "@mantine/core";
import { useEffect, useState, type ReactNode } from "react";
import { RejectionNote } from "../../rest/RejectionNote";
import { Rejection } from "../../rest/client";
import { useTexts } from "../../texts/TextsContext";
import { downloadFile } from "../parts/transfer";

/** A plot of a calibration. The file is arbitrary bytes and is only used as an image source. */
export function Plot({ caseId, file, name }: { caseId: string; file: string; name: string }): ReactNode {
  const texts = useTexts().rest;
  const [address, setAddress] = useState<string | null>(null);
  const [rejection, setRejection] = useState<Rejection | null>(null);
  useEffect(() => {
    const stop = new AbortController();
    let made: string | null = null;
    downloadFile(`/api/cases/${caseId}/files/${file}`, () => undefined, stop.signal)
      .then((bytes) => {
        if (stop.signal.aborted) return;
        made = URL.createObjectURL(new Blob([bytes], { type: "image/svg+xml" }));
        setAddress(made);
      })
      .catch((error: unknown) => {
        if (error instanceof Rejection) setRejection(error);
      });
    return () => {
      stop.abort();
      if (made !== null) URL.revokeObjectURL(made);
    };
  }, [caseId, file]);
  if (rejection !== null) return <RejectionNote rejection={rejection} />;
  if (address === null) return <Loader aria-label={texts.loading} />;
  return (
    <figure className="plot">
      <img src={address} alt={name} />
      <figcaption>{name}</figcaption>
    </figure>
  );
}
