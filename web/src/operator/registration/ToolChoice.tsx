import { SegmentedControl } from "@mantine/core";
import type { ReactNode } from "react";
import { EmptyState } from "../../panes/EmptyState";
import { PageLink } from "../../rest/PageLink";
import { useTexts } from "../../texts/TextsContext";
import { useTools } from "./useTools";

interface ToolChoiceProps {
  tool: string;
  onTool: (tool: string) => void;
}

/** Choice of the tool; nothing if there is only one. */
export function ToolChoice({ tool, onTool }: ToolChoiceProps): ReactNode {
  const { registration: texts, rest } = useTexts();
  const tools = useTools();
  if (tools === null) return <p className="loading">{rest.loading}</p>;
  if (tools.length === 0)
    return (
      <EmptyState drawing="tool" sentence={texts.tool.none}>
        <PageLink page="tool" />
      </EmptyState>
    );
  if (tools.length === 1)
    return (
      <p>
        {texts.tool.touches}: <strong>{tool}</strong>
      </p>
    );
  return (
    <div>
      <p>{texts.tool.touches}:</p>
      <SegmentedControl
        size="lg"
        aria-label={texts.tool.touches}
        data={tools.map((one) => one.name)}
        value={tool}
        onChange={onTool}
      />
    </div>
  );
}
