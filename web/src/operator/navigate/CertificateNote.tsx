import type { ReactNode } from "react";
import { Link } from "wouter";
import { certificateText } from "../../panes/certificateText";
import { useCertificates } from "../../rest/useCertificates";
import { useTexts } from "../../texts/TextsContext";

/** Whether the accuracy is certified, in one line. Information, no gate. */
export function CertificateNote(): ReactNode {
  const texts = useTexts().certificate;
  const { data } = useCertificates();
  if (data === null) return null;
  return (
    <p className="quiet" role="status" data-testid="certified">
      {texts.accuracy}: {certificateText(data, texts)}{" "}
      <Link className="big-link" href="/operator/tool">
        {texts.title}
      </Link>
    </p>
  );
}
