import { Alert } from "@mantine/core";
import type { ReactNode } from "react";
import { sentence } from "./format";

export interface Remark {
  code: string;
  message: string;
  /** Empty if there is nothing to do. */
  remedy: string;
}

/** Warnings about completed work, as the server words them. */
export function Remarks({ remarks }: { remarks: readonly Remark[] }): ReactNode {
  return remarks.map((one) => (
    <Alert key={one.code + one.message} className="consequence" title={sentence(one.message)}>
      {one.remedy}
    </Alert>
  ));
}
