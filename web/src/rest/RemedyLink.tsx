import type { ReactNode } from "react";
import { useLocation } from "wouter";
import { PageLink } from "./PageLink";
import { remedyPageOf } from "./remedyPage";

/** A button to the page that remedies this error; nothing if there is none. */
export function RemedyLink({ code }: { code: string }): ReactNode {
  const [path] = useLocation();
  const page = remedyPageOf(code, path);
  return page === null ? null : <PageLink page={page} />;
}
