// Whether the tools in use are certified, in one line.
import { formatNumber } from "../live/rounding";
import type { Certificates, ToolCertification } from "../rest/useCertificates";
import type { CertificateTexts } from "../texts/certificate/en";
import { interpolate } from "../texts/interpolate";

/** The tools are named only where there are several. Without images none is known, and nothing is certified. */
export function certificateText({ tools }: Pick<Certificates, "tools">, texts: CertificateTexts): string {
  if (tools.length === 0) return texts.notCertified;
  if (tools.length === 1) return tools.map((one) => toolCertificateText(one, texts)).join("");
  return tools
    .map((one) => interpolate(texts.ofTool, { tool: one.tool, state: toolCertificateText(one, texts) }))
    .join("; ");
}

/** Error and date are stated only while the certificate is valid. */
export function toolCertificateText(one: ToolCertification, texts: CertificateTexts): string {
  if (!one.certified || one.error_95_mm === null || one.valid_until === null) return texts.notCertified;
  return interpolate(texts.certified, {
    day: one.valid_until.slice(0, 10),
    mm: formatNumber(one.error_95_mm, 2),
  });
}
