// Whether the accuracy of the tools in use is certified.
import { getCertificates, type CertificatesMessage } from "../api";
import { useQuery, type QueryState } from "./useQuery";

export type Certificates = CertificatesMessage;
export type ToolCertification = Certificates["tools"][number];

/** A certificate expires by the day, and is void with another camera or tool, which is calibrated for minutes. */
const ASK_EVERY_MS = 30_000;

export function useCertificates(): QueryState<Certificates> {
  return useQuery((signal) => getCertificates({ signal }), { everyMs: ASK_EVERY_MS });
}
