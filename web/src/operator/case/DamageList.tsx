import type { ReactNode } from "react";
import type { DamageMessage } from "../../api";
import { sentence } from "../parts/format";

/** Damaged documents and files, with the documents that need them. */
export function DamageList({ damages }: { damages: readonly DamageMessage[] }): ReactNode {
  return (
    <ul>
      {damages.map((one) => (
        <li key={one.file_id}>
          {sentence(one.message)} {one.documents.join(", ")}
        </li>
      ))}
    </ul>
  );
}
