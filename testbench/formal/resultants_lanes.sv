// The lanes as the turns of a design that puts out resultants only see them: one program, of any length.
module subject_spmv_array #(
    parameter ROM_DIR = ""
) (
    input wire clock,
    input wire reset,
    input wire start,
    output wire issued,
    output wire issuing_now
);

    reg issuing = 1'b0;
    wire go = $anyseq;

    assign issuing_now = issuing;
    assign issued = go && issuing;

    always @(posedge clock) begin
        issuing <= start || (issuing && !issued);
        if (reset) begin
            issuing <= 1'b0;
        end
    end

endmodule
