import type { ReactNode } from "react";
import { Link } from "wouter";
import { interpolate } from "../texts/interpolate";
import { useTexts } from "../texts/TextsContext";
import type { PageName } from "./remedyPage";

/** A button to a page of the operator, where something is to be done first. */
export function PageLink({ page }: { page: PageName }): ReactNode {
  const { operator, rest } = useTexts();
  return (
    <Link className="big-link" href={`/operator/${page}`} data-testid={`go-${page}`}>
      {interpolate(rest.goTo, { page: operator.page[page] })}
    </Link>
  );
}
