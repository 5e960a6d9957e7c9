// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Ingress frame FIFO for a source without back-pressure, two frames deep. A frame that finds it full is dropped whole.
//
// Latency 2 cycles, one beat a cycle. A frame is handed on while it comes in. Of surplus beats only the last one goes
// on: the frame stays too long, and has room.

`default_nettype none

module sptfra_ingress_fifo #(
    // Beats of a frame
    parameter BEATS = 12,
    // 32-bit words of a beat: 1, 2 or 4
    parameter WORDS = 1
) (
    input  wire clock,
    input  wire reset,
    // Stream in, always ready
    input  wire [32*WORDS-1:0] s_tdata,
    input  wire s_tlast,
    input  wire s_tvalid,
    output wire s_tready,
    output wire kept, // the beat taken now is one of a frame that has room
    output wire dropped, // a frame that had none ends now
    output reg  follows_dropped, // with a first beat that is kept: frames before it had no room
    // Frames that have room
    output wire [32*WORDS-1:0] m_tdata,
    output wire m_tlast,
    output reg  m_tvalid,
    input  wire m_tready
);

    localparam FRAMES = 2; // that wait
    localparam LENGTH = BEATS + 1; // stored of a frame, at most
    localparam DEPTH = FRAMES * LENGTH;
    localparam ADDRESS_WIDTH = $clog2(DEPTH);
    localparam COUNT_WIDTH = $clog2(DEPTH + 1);
    localparam INDEX_WIDTH = $clog2(BEATS + 1);
    localparam [31:0] END_WIDE = BEATS;
    localparam [31:0] TOP_WIDE = DEPTH - 1;
    localparam [INDEX_WIDTH-1:0] END = END_WIDE[INDEX_WIDTH-1:0];
    localparam [ADDRESS_WIDTH-1:0] TOP = TOP_WIDE[ADDRESS_WIDTH-1:0];

    if ((WORDS != 1) && (WORDS != 2) && (WORDS != 4)) begin : gen_check_words
        sptfra_error_words_must_be_1_2_or_4 invalid ();
    end

    // ---- In
    reg [1:0] frames; // that wait, or are coming in
    reg [INDEX_WIDTH-1:0] index; // of the next beat of the frame, stops at BEATS
    wire begins;
    wire dropping;
    wire store = kept && ((index != END) || s_tlast);

    sptfra_whole_frames whole_frames (
        .clock    (clock),
        .reset    (reset),
        .s_tvalid (s_tvalid),
        .s_tlast  (s_tlast),
        .s_tready (s_tready),
        .room     (frames != FRAMES),
        .kept     (kept),
        .begins   (begins),
        .dropping (dropping),
        .dropped  (dropped)
    );

    // ---- Frames that wait, in a ring
    reg [ADDRESS_WIDTH-1:0] write_address;
    reg [ADDRESS_WIDTH-1:0] read_address;
    reg [COUNT_WIDTH-1:0] waiting; // beats there
    wire read = (waiting != {COUNT_WIDTH{1'b0}}) && (!m_tvalid || m_tready);
    wire leaves = m_tvalid && m_tready && m_tlast;

    sptfra_ram #(
        .WIDTH         (32 * WORDS + 1),
        .DEPTH         (DEPTH),
        .ADDRESS_WIDTH (ADDRESS_WIDTH)
    ) ring (
        .clock         (clock),
        .write_enable  (store),
        .write_address (write_address),
        .write_data    ({s_tlast, s_tdata}),
        .read_enable   (read),
        .read_address  (read_address),
        .read_data     ({m_tlast, m_tdata})
    );

    always @(posedge clock) begin
        if (kept) begin
            index <= s_tlast ? {INDEX_WIDTH{1'b0}} : (index != END) ? index + 1'b1 : index;
        end
        if (store) begin
            write_address <= (write_address == TOP) ? {ADDRESS_WIDTH{1'b0}} : write_address + 1'b1;
        end
        if (read) begin
            read_address <= (read_address == TOP) ? {ADDRESS_WIDTH{1'b0}} : read_address + 1'b1;
        end
        waiting <= waiting + {{(COUNT_WIDTH-1){1'b0}}, store} - {{(COUNT_WIDTH-1){1'b0}}, read};
        m_tvalid <= read || (m_tvalid && !m_tready);
        frames <= frames + {1'b0, begins} - {1'b0, leaves};
        if (reset) begin
            index <= {INDEX_WIDTH{1'b0}};
            write_address <= {ADDRESS_WIDTH{1'b0}};
            read_address <= {ADDRESS_WIDTH{1'b0}};
            waiting <= {COUNT_WIDTH{1'b0}};
            m_tvalid <= 1'b0;
            frames <= 2'd0;
        end
    end

    // ---- Whether frames were dropped since the last one that has room
    always @(posedge clock) begin
        if (begins) begin
            follows_dropped <= 1'b0;
        end
        if (dropped) begin
            follows_dropped <= 1'b1;
        end
        if (reset) begin
            follows_dropped <= 1'b0;
        end
    end

    wire _unused = dropping;

`ifdef SIMULATION
    // A frame that is kept has room for all of it
    always @(posedge clock) begin
        if (!reset && ((store && (waiting == DEPTH)) || (begins && (frames == FRAMES)))) begin
            $fdisplay(32'h80000002, "%m: a frame is kept that has no room");
            $fatal(1);
        end
    end
`endif

endmodule

`default_nettype wire
