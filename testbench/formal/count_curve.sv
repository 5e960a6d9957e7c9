// SPDX-License-Identifier: MIT OR Apache-2.0
//
// A curve in the banks of a calibration: every beat of a frame goes by the bank that acted at the frame's first one, up to
// the line that it reads, beats leave as they came, and no more ends of frames are on their way than are counted.
module harness (
    input wire clock,
    input wire [31:0] s_tdata,
    input wire s_tlast,
    input wire s_tvalid,
    input wire m_tready,
    input wire change
);

    reg started = 1'b0;
    reg active = 1'b0;
    wire reset = !started;
    wire s_tready;
    wire frame_begins;
    wire advance;
    wire bank;
    wire bank_held;
    wire in_frame;
    wire line_bank;
    wire [1:0] ends_inside;
    wire [24:1] valid;
    wire [11:1] banks;

    sptfra_count_curve subject (
        .clock        (clock),
        .reset        (reset),
        .s_tdata      (s_tdata),
        .s_tlast      (s_tlast),
        .s_tvalid     (s_tvalid),
        .s_tready     (s_tready),
        .m_tready     (m_tready),
        .active       (active),
        .frame_begins (frame_begins),
        .line_bank    (line_bank),
        // Inside
        .advance      (advance),
        .bank         (bank),
        .bank_held    (bank_held),
        .in_frame     (in_frame),
        .ends_inside  (ends_inside),
        .valid        (valid),
        .banks        (banks)
    );

    wire taken = s_tvalid && s_tready;
    reg open;
    reg its_bank;
    reg [11:1] right; // the banks that beats on their way should have

    always @(posedge clock) begin
        started <= 1'b1;
        active <= active ^ change;
        if (taken) begin
            open <= !s_tlast;
            its_bank <= open ? its_bank : active;
        end
        if (advance) begin
            right <= {right[10:1], open ? its_bank : active};
        end
        if (reset) begin
            open <= 1'b0;
        end
    end

    always @(posedge clock) begin
        if (!reset) begin
            assert (!taken || (bank == (open ? its_bank : active)));
            assert (frame_begins == (taken && !open));
            assert (!valid[11] || (line_bank == right[11]));
            assert (s_tready || !advance || (!in_frame && (ends_inside == 2'd3)));
        end
    end

`ifdef INVARIANTS
    always @(posedge clock) begin
        if (!reset) begin
            assert (in_frame == open);
            assert (!open || (bank_held == its_bank));
            assert (((banks ^ right) & valid[11:1]) == 11'd0);
        end
    end
`endif

endmodule
