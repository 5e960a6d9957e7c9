// The lanes as the turns of the reduced plan see them: one program at a time, each of any length.
module subject_spmv_array #(
    parameter ROM_DIR = ""
) (
    input wire clock,
    input wire reset,
    input wire [2:0] start,
    output wire issued,
    output wire [2:0] issuing_now
);

    reg [2:0] issuing = 3'd0;
    wire go = $anyseq;

    assign issuing_now = issuing;
    assign issued = go && (issuing != 3'd0);

    always @(posedge clock) begin
        if (issued) begin
            issuing <= 3'd0;
        end
        if (start != 3'd0) begin
            issuing <= start;
        end
        if (reset) begin
            issuing <= 3'd0;
        end
    end

endmodule
